// The order in which edges are worked on.
#pragma once

#include <algorithm>
#include <vector>

#include "tracking/mesh/adjacency.h"

namespace flowskin::tracking {

enum class EdgeOrder { shortest_first, longest_first };

/// The numbers of the edges for which condition(edge, length in m) holds, by length, then by number: the outcome of
/// what is done to them does not depend on chance.
template <class Condition>
std::vector<int> edges_by_length(const MeshAdjacency& topology, const std::vector<Vec3>& positions, EdgeOrder order,
                                 const Condition& condition) {
  const std::vector<double> lengths = edge_lengths(topology, positions);
  std::vector<int> edges;
  for (int e = 0; e < static_cast<int>(lengths.size()); ++e) {
    if (condition(e, lengths[e])) edges.push_back(e);
  }
  std::sort(edges.begin(), edges.end(), [&](int a, int b) {
    if (lengths[a] != lengths[b]) return (lengths[a] < lengths[b]) == (order == EdgeOrder::shortest_first);
    return a < b;
  });
  return edges;
}

}  // namespace flowskin::tracking
