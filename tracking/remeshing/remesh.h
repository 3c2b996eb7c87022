// Keeps the edges of a stretching mesh near their target length: split, collapse, flip. See docs/remeshing.md.
#pragma once

#include <functional>
#include <vector>

#include "tracking/advection/projection.h"
#include "tracking/extraction/marching_cubes.h"
#include "tracking/field/implicit_field.h"
#include "tracking/mesh/adjacency.h"
#include "tracking/mesh/surface_mesh.h"

namespace flowskin::tracking {

/// Limits in target edge lengths; a mesh within them is left untouched, bit for bit.
struct RemeshSettings {
  double edge_length = 0;       ///< Target (m); must be given.
  double longest = 1.35;        ///< A longer edge is split in the middle.
  double shortest = 0.5;        ///< A shorter edge is collapsed into one of its ends.
  double delaunay_slack = 0.5;  ///< An edge is flipped where its opposite angles exceed 180 degrees by this (rad).
  double torn = 0;  ///< An edge whose ends were so many times its length apart at rest joins two bodies; 0: none does.
  double curvature =
      0;  ///< The target is at most this multiple of the smaller radius of curvature; 0: the same everywhere.
  double finest = 0.5;  ///< But not less than this.
};

/// How often each operation was done.
struct RemeshReport {
  int splits = 0, collapses = 0, flips = 0;
  bool changed() const { return splits + collapses + flips > 0; }
};

/// One pass of splits, collapses and flips. A vertex that stays keeps its position, rest position and id; the one in
/// the middle of a split edge takes the mean of its ends' rest positions, a new id, and is put on the surface; its rest
/// position follows as far as the surface was bent there at rest, too.
/// @pre `mesh` is closed and two-manifold; it stays so.
RemeshReport remesh(const ImplicitField& field, const RemeshSettings& settings, SurfaceMesh& mesh);

/// The same on any surface.
/// @param put_on_surface moves points onto it
/// @param sizes the target at each vertex, in edge lengths; an edge takes the smaller one of its ends. Empty: 1.
RemeshReport remesh(const std::function<void(std::vector<Vec3>&)>& put_on_surface, const RemeshSettings& settings,
                    SurfaceMesh& mesh, std::vector<double> sizes = {});

/// A surface that remeshing leaves alone: passes on a fresh one until few operations are left, with the edges evened
/// out between them. A mesh that is tracked from there on keeps its vertices in the first frame.
SurfaceGeometry settled(const ImplicitField& field, const RemeshSettings& settings, SurfaceGeometry surface);

/// Targets by curvature at points on the surface, in edge lengths: `curvature` times the smaller radius of curvature,
/// held between `finest` and 1.
std::vector<double> sizes_by_curvature(const ImplicitField& field, const RemeshSettings& settings,
                                       const std::vector<Vec3>& positions);

/// Rest lengths of the springs after remeshing: an edge that was there before keeps its own, a new one takes its
/// present length, held between 0.7 and 1.3 target lengths.
/// @param old_ids, old_topology, old_lengths vertex ids, edges and rest lengths before
std::vector<double> carry_rest_lengths(const std::vector<std::uint64_t>& old_ids, const MeshAdjacency& old_topology,
                                       const std::vector<double>& old_lengths, const SurfaceMesh& mesh,
                                       const MeshAdjacency& topology, double edge_length);

}  // namespace flowskin::tracking
