// Carries material coordinates from particles and from an old mesh to a new one.
#pragma once

#include <vector>

#include "tracking/extraction/marching_cubes.h"
#include "tracking/field/metaball_field.h"
#include "tracking/mesh/surface_mesh.h"
#include "tracking/particles.h"

namespace flowskin::tracking {

/// Rest position of the material at a point, from the particles around it: moving least squares of first order of their
/// displacement, over those nearer than the field's radius whose material belongs to that of the nearest one; their
/// weighted mean where they do not span space; that of the nearest particle where there is only one. Exact where the
/// displacement is linear.
/// @param field whose first positions are those of `particles`, in their order
/// @pre There is at least one particle, and their rest positions are known.
Vec3 rest_position_at(const MetaballField& field, const Particles& particles, const Vec3& x);

/// Distance between the rest position that each vertex carries and that of the particles beneath it (m): how far the
/// texture has drifted off its material.
std::vector<double> material_drift(const SurfaceMesh& mesh, const MetaballField& field, const Particles& particles);

/// How an old mesh hands its material over; lengths in metres.
struct MaterialSettings {
  double reach = 0;        ///< Farthest distance to the old mesh.
  double same_vertex = 0;  ///< Old and new vertex may be the same one within this distance.
  double far_reach = 0;    ///< Farthest distance to the old mesh where particles know no rest positions.
};

/// A mesh of fresh geometry with its attributes: the rest position of the closest point of the old mesh that looks the
/// same way, interpolated once over its triangle; where there is none, that of the particles beneath. The old mesh is
/// preferred even where the particles have come to disagree with it: two truths side by side would tear the texture. A
/// vertex keeps the id of an old one where each is the other's nearest; all others get new ids. Velocities are zero.
/// Where particles know no rest positions, new surface takes the displacement of the closest point of the old mesh
/// within far_reach, whichever way it looks: wrong by at most twice their distance where the material moved rigidly.
/// Farther away, and where there is no old mesh, its own place.
/// @param old_mesh at the time of the field; may be empty
/// @param normals outward normals of the geometry's vertices
SurfaceMesh carry_material(const SurfaceMesh& old_mesh, const SurfaceGeometry& geometry,
                           const std::vector<Vec3>& normals, const MetaballField& field, const Particles& particles,
                           const MaterialSettings& settings);

}  // namespace flowskin::tracking
