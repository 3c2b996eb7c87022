#include "tracking/mesh/adjacency.h"

#include <algorithm>
#include <numeric>

namespace flowskin::tracking {
namespace {

void build_stars(int vertex_count, const std::vector<Triangle>& triangles, MeshAdjacency& topology) {
  topology.triangle_begin.assign(vertex_count + 1, 0);
  for (const Triangle& triangle : triangles) {
    for (int vertex : triangle) ++topology.triangle_begin[vertex + 1];
  }
  std::partial_sum(topology.triangle_begin.begin(), topology.triangle_begin.end(), topology.triangle_begin.begin());
  topology.triangles_of.resize(3 * triangles.size());
  std::vector<int> cursor(topology.triangle_begin.begin(), topology.triangle_begin.end() - 1);
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
    for (int vertex : triangles[t]) topology.triangles_of[cursor[vertex]++] = t;
  }
}

// A side of a triangle, seen from its lower vertex.
struct Side {
  int higher, triangle;
  bool operator<(const Side& other) const {
    return higher != other.higher ? higher < other.higher : triangle < other.triangle;
  }
};

// The edges that start at their lower vertex, in lexicographic order.
void build_edges(int vertex_count, const std::vector<Triangle>& triangles, MeshAdjacency& topology) {
  std::vector<Side> sides(6 * triangles.size());  // those of a vertex begin at twice its triangle_begin
  std::vector<int> side_count(vertex_count, 0), edge_begin(vertex_count + 1, 0);
#pragma omp parallel for schedule(static)
  for (int vertex = 0; vertex < vertex_count; ++vertex) {
    Side* const begin = sides.data() + 2 * static_cast<std::ptrdiff_t>(topology.triangle_begin[vertex]);
    Side* end = begin;
    for (int t : topology.star(vertex)) {
      for (int other : triangles[t]) {
        if (other > vertex) *end++ = {other, t};
      }
    }
    std::sort(begin, end);
    side_count[vertex] = static_cast<int>(end - begin);
    for (const Side* side = begin; side != end; ++side) {
      edge_begin[vertex + 1] += side == begin || side->higher != side[-1].higher;
    }
  }
  std::partial_sum(edge_begin.begin(), edge_begin.end(), edge_begin.begin());
  topology.edges.resize(edge_begin.back());
  topology.edge_triangles.resize(edge_begin.back());
#pragma omp parallel for schedule(static)
  for (int vertex = 0; vertex < vertex_count; ++vertex) {
    const Side* const begin = sides.data() + 2 * static_cast<std::ptrdiff_t>(topology.triangle_begin[vertex]);
    int edge = edge_begin[vertex] - 1;
    for (const Side* side = begin; side != begin + side_count[vertex]; ++side) {
      if (side == begin || side->higher != side[-1].higher) {
        topology.edges[++edge] = {vertex, side->higher};
        topology.edge_triangles[edge] = {side->triangle, -1};
      } else if (topology.edge_triangles[edge][1] < 0) {
        topology.edge_triangles[edge][1] = side->triangle;
      }
    }
  }
}

}  // namespace

MeshAdjacency build_adjacency(int vertex_count, const std::vector<Triangle>& triangles) {
  MeshAdjacency topology;
  build_stars(vertex_count, triangles, topology);
  build_edges(vertex_count, triangles, topology);

  topology.neighbor_begin.assign(vertex_count + 1, 0);
  for (const auto& [low, high] : topology.edges) {
    ++topology.neighbor_begin[low + 1];
    ++topology.neighbor_begin[high + 1];
  }
  std::partial_sum(topology.neighbor_begin.begin(), topology.neighbor_begin.end(), topology.neighbor_begin.begin());
  topology.neighbors.resize(2 * topology.edges.size());
  std::vector<int> cursor(topology.neighbor_begin.begin(), topology.neighbor_begin.end() - 1);
  // Lexicographic order of the edges makes each ring ascending: first the lower neighbours, then the higher ones.
  for (int e = 0; e < static_cast<int>(topology.edges.size()); ++e) {
    topology.neighbors[cursor[topology.edges[e][1]]++] = {topology.edges[e][0], e};
  }
  for (int e = 0; e < static_cast<int>(topology.edges.size()); ++e) {
    topology.neighbors[cursor[topology.edges[e][0]]++] = {topology.edges[e][1], e};
  }
  return topology;
}

std::vector<double> edge_lengths(const MeshAdjacency& topology, const std::vector<Vec3>& positions) {
  std::vector<double> lengths(topology.edges.size());
  for (std::size_t e = 0; e < lengths.size(); ++e) {
    lengths[e] = (positions[topology.edges[e][1]] - positions[topology.edges[e][0]]).norm();
  }
  return lengths;
}

}  // namespace flowskin::tracking
