// Who is next to whom in a triangle mesh.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "tracking/mesh/surface_mesh.h"

namespace flowskin::tracking {

/// One-ring adjacency in compressed rows. Made once for a mesh; stays valid while its triangles do not change.
struct MeshAdjacency {
  /// A neighbour of a vertex and the edge that leads to it.
  struct Neighbor {
    int vertex;
    int edge;
  };

  std::vector<std::array<int, 2>> edges;           ///< (low, high) vertex, in lexicographic order.
  std::vector<std::array<int, 2>> edge_triangles;  ///< The first two triangles of an edge; -1 where there is none.
  std::vector<int> neighbor_begin;                 ///< One entry per vertex, and one more.
  std::vector<Neighbor> neighbors;                 ///< Ascending within a vertex.
  std::vector<int> triangle_begin;                 ///< One entry per vertex, and one more.
  std::vector<int> triangles_of;                   ///< Triangles around a vertex, ascending.

  int vertex_count() const { return static_cast<int>(neighbor_begin.size()) - 1; }
  /// The one-ring of a vertex.
  std::span<const Neighbor> ring(int vertex) const {
    return {neighbors.data() + neighbor_begin[vertex], neighbors.data() + neighbor_begin[vertex + 1]};
  }
  /// The triangles around a vertex.
  std::span<const int> star(int vertex) const {
    return {triangles_of.data() + triangle_begin[vertex], triangles_of.data() + triangle_begin[vertex + 1]};
  }
};

/// Accepts any triangles whose indices lie in [0, vertex_count); says nothing about manifoldness (see mesh_check.h).
MeshAdjacency build_adjacency(int vertex_count, const std::vector<Triangle>& triangles);

/// Length of each edge (m), in the order of topology.edges.
std::vector<double> edge_lengths(const MeshAdjacency& topology, const std::vector<Vec3>& positions);

}  // namespace flowskin::tracking
