// Carries material coordinates from particles and from an old mesh to a new one.
#pragma once

#include <span>
#include <vector>

#include "common/closest_point.h"
#include "tracking/extraction/marching_cubes.h"
#include "tracking/field/implicit_field.h"
#include "tracking/field/particle_field.h"
#include "tracking/mesh/adjacency.h"
#include "tracking/mesh/point_tree.h"
#include "tracking/mesh/surface_mesh.h"
#include "tracking/particles.h"

namespace flowskin::tracking {

/// Rest position of the material at a point, from the particles around it: moving least squares of first order of their
/// displacement, over those nearer than the field's radius whose material belongs to that of the nearest one; their
/// weighted mean where they do not span space; that of the nearest particle where there is only one. Exact where the
/// displacement is linear.
/// @param field whose first positions are those of `particles`, in their order
/// @pre There is at least one particle, and their rest positions are known.
Vec3 rest_position_at(const ParticleField& field, const Particles& particles, const Vec3& x);

/// The same for other places of the particles' material (m), one per particle.
/// @pre There is at least one particle.
Vec3 material_place_at(const ParticleField& field, const std::vector<Vec3>& particle_places, const Vec3& x);

/// Distance between the rest position that each vertex carries and that of the particles beneath it (m): how far the
/// texture has drifted off its material.
std::vector<double> material_drift(const SurfaceMesh& mesh, const ParticleField& field, const Particles& particles);

/// How far the material of a particle lies from where that of its neighbours puts it (m): the distance between its rest
/// position and the moving-least-squares rest position of the others at its place, for at most `most` particles evenly
/// spread over their ids. 0 where the motion is smooth; where particles have mixed, no texture that is smooth can be
/// nearer to them than this. A particle without neighbours counts for nothing.
std::vector<double> material_scatter(const ParticleField& field, const Particles& particles, std::size_t most = 1000);

/// Holds the rest positions of a mesh within `limit` (m) of those of the particles beneath: farther ones are pulled
/// back to that distance. A surface that is carried by the best of velocities still slips off its particles in time,
/// and where fluid comes from an inlet, or up from inside, new surface would go on with the material of its neighbours.
/// @return how many vertices were held back
int limit_slip(double limit, const ParticleField& field, const Particles& particles, SurfaceMesh& mesh);

/// How an old mesh hands its material over; lengths in metres.
struct MaterialSettings {
  double reach = 0;        ///< Farthest distance to the old mesh.
  double same_vertex = 0;  ///< Old and new vertex may be the same one within this distance.
  double far_reach = 0;    ///< Farthest distance to the old mesh where particles know no rest positions.
};

/// Tells where the material of a place on the surface was at rest: the rest position of the closest point of an old
/// surface that looks the same way, interpolated there as by MaterialChart; where there is none, that of the particles
/// beneath. The old surface is preferred even where the particles have come to disagree with it: where both were used
/// side by side, the texture would tear. Where particles know no rest positions, new surface takes the displacement of
/// the closest point of the old one within far_reach, whichever way it looks: wrong by at most twice their distance
/// where the material moved rigidly. Farther away, and where there is no old surface, its own place.
class MaterialCarrier {
 public:
  /// Keeps references to all.
  MaterialCarrier(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                  const ImplicitField& field, const Particles& particles, const MaterialSettings& settings);
  /// Appends rest positions and layers of the material at these places of the surface to those of `mesh`.
  /// @param old what the vertices of the old surface know of the material; may be `mesh` itself
  /// @param normals outward, of the surface at the places
  void append_material(const SurfaceMesh& old, std::span<const Vec3> places, std::span<const Vec3> normals,
                       SurfaceMesh& mesh) const;

 private:
  /// Where a place takes its material from; no triangle: not from there.
  struct Source {
    MeshPoint same_side, any_side;
  };
  Source source_of(const Vec3& x, const Vec3& normal, bool particles_know) const;
  /// @param on_mesh of the old surface's vertices  @param on_particles of the particles; empty: unknown
  Vec3 place(const Vec3& x, const Source& source, const std::vector<Vec3>& on_mesh,
             const std::vector<Vec3>& on_particles) const;
  Vec3 on_triangle(const MeshPoint& point, const std::vector<Vec3>& values) const;
  Vec3 on_surface(const MeshPoint& point, const std::vector<Vec3>& values) const;

  const std::vector<Vec3>& positions_;
  const std::vector<Triangle>& triangles_;
  const ImplicitField& field_;
  const Particles& particles_;
  MaterialSettings settings_;
  ClosestPointTree tree_;
  MeshAdjacency adjacency_;
  std::vector<Vec3> normals_;
};

/// The places of layer k of the particles; none where they are unknown.
const std::vector<Vec3>& particle_layer(const Particles& particles, std::size_t k);

/// For each new vertex the old one that it goes on as, under its id; -1: none. Of the vertices nearer than `reach` (m)
/// that look the same way (less than 90 degrees off), each is the other's nearest: no id goes from one side of a thin
/// sheet to the other. Both when regions are replaced and when the whole mesh is.
std::vector<int> same_vertices(const SurfacePoints& old_vertices, const SurfacePoints& new_vertices, double reach);

/// A mesh of fresh geometry with its attributes: rest positions and layers as MaterialCarrier says, ids as
/// same_vertices says; all others get new ids. Velocities are zero.
/// @param old_mesh at the time of the field; may be empty
/// @param normals outward normals of the geometry's vertices
SurfaceMesh carry_material(const SurfaceMesh& old_mesh, const SurfaceGeometry& geometry,
                           const std::vector<Vec3>& normals, const ImplicitField& field, const Particles& particles,
                           const MaterialSettings& settings);

}  // namespace flowskin::tracking
