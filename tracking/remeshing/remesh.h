// Keeps the edges of a stretching mesh near their target length: split, collapse, flip. See docs/remeshing.md.
#pragma once

#include <vector>

#include "tracking/advection/projection.h"
#include "tracking/field/metaball_field.h"
#include "tracking/mesh/surface_mesh.h"
#include "tracking/mesh/topology.h"

namespace flowskin::tracking {

/// Limits in target edge lengths; a mesh within them is left untouched, bit for bit.
struct RemeshSettings {
  double edge_length = 0;       ///< Target (m); must be given.
  double longest = 1.35;        ///< A longer edge is split in the middle.
  double shortest = 0.5;        ///< A shorter edge is collapsed into one of its ends.
  double delaunay_slack = 0.5;  ///< An edge is flipped where its opposite angles exceed 180 degrees by this (rad).
};

/// How often each operation was done.
struct RemeshReport {
  int splits = 0, collapses = 0, flips = 0;
  bool changed() const { return splits + collapses + flips > 0; }
};

/// One pass of splits, collapses and flips. A vertex that stays keeps its position, rest position and id; the one in
/// the middle of a split edge takes the mean of its ends' rest positions, a new id, and is put on the surface.
/// @pre `mesh` is closed and two-manifold; it stays so.
RemeshReport remesh(const MetaballField& field, const RemeshSettings& settings, SurfaceMesh& mesh);

/// Rest lengths of the springs after remeshing: an edge that was there before keeps its own, a new one takes its
/// present length, held between 0.7 and 1.3 target lengths.
/// @param old_ids, old_topology, old_lengths vertex ids, edges and rest lengths before
std::vector<double> carry_rest_lengths(const std::vector<std::uint64_t>& old_ids, const MeshTopology& old_topology,
                                       const std::vector<double>& old_lengths, const SurfaceMesh& mesh,
                                       const MeshTopology& topology, double edge_length);

}  // namespace flowskin::tracking
