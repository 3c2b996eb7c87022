#include "tracking/mesh/self_intersections.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "tracking/mesh/orientation.h"
#include "tracking/mesh/triangle_pair.h"
#include "tracking/mesh/triangle_tree.h"

namespace flowskin::tracking {
namespace {

using Pair = std::array<int, 2>;

// The positions as the exact predicates want them.
std::vector<Vec3> checked(std::vector<Vec3> positions) {
  for (std::size_t v = 0; v < positions.size(); ++v) {
    for (double& value : positions[v]) {
      if (!(std::abs(value) <= kLargestCoordinate)) {
        throw std::invalid_argument("vertex " + std::to_string(v) + " is at no place below 1e60 m");
      }
      if (std::abs(value) < kSmallestCoordinate) value = 0;
    }
  }
  return positions;
}

void check(int vertex_count, const std::vector<Triangle>& triangles) {
  const auto fail = [&](const Triangle& triangle, const char* fault) {
    throw std::invalid_argument("triangle " + std::to_string(&triangle - triangles.data()) + fault);
  };
  for (const Triangle& triangle : triangles) {
    const auto& [a, b, c] = triangle;
    if (std::min({a, b, c}) < 0 || std::max({a, b, c}) >= vertex_count) fail(triangle, " has an index out of range");
    if (a == b || b == c || c == a) fail(triangle, " names a vertex twice");
  }
}

class Search {
 public:
  Search(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles)
      : positions_(positions), triangles_(triangles), tree_(positions, triangles) {
    for (int node = 0; node < static_cast<int>(tree_.nodes().size()); ++node) {
      if (tree_.nodes()[node].right < 0) leaves_.push_back(node);
    }
  }

  std::vector<Pair> run() const {
    std::vector<Pair> found;
#pragma omp parallel
    {
      std::vector<Pair> mine;
#pragma omp for schedule(dynamic, 64) nowait
      for (int i = 0; i < static_cast<int>(leaves_.size()); ++i) compare(0, tree_.nodes()[leaves_[i]], mine);
#pragma omp critical(flowskin_self_intersections)
      found.insert(found.end(), mine.begin(), mine.end());
    }
    std::sort(found.begin(), found.end());
    return found;
  }

 private:
  using Node = TriangleTree::Node;

  // Compares a leaf with the triangles of a subtree that do not come before it.
  void compare(int index, const Node& leaf, std::vector<Pair>& found) const {
    const Node& node = tree_.nodes()[index];
    if (node.end <= leaf.begin || !node.box.overlaps(leaf.box)) return;
    if (node.right >= 0) {
      compare(index + 1, leaf, found);
      compare(node.right, leaf, found);
      return;
    }
    for (int i = leaf.begin; i < leaf.end; ++i) {
      for (int j = std::max(i + 1, node.begin); j < node.end; ++j) {
        if (!tree_.boxes()[i].overlaps(tree_.boxes()[j])) continue;
        const int s = tree_.order()[i], t = tree_.order()[j];
        if (meet(triangles_[s], triangles_[t])) found.push_back({std::min(s, t), std::max(s, t)});
      }
    }
  }

  Corners corners(const Triangle& triangle) const {
    return {positions_[triangle[0]], positions_[triangle[1]], positions_[triangle[2]]};
  }

  bool meet(Triangle s, Triangle t) const {
    const int shared = bring_shared_first(s, t);
    if (shared == 0) return triangles_meet(corners(s), corners(t));
    if (shared == 1) return triangles_meet_beyond_corner(corners(s), corners(t));
    return shared == 3 || triangles_meet_beyond_edge(corners(s), corners(t));
  }

  // Orders the corners of two triangles so that those they share come first, in the same order. Returns how many.
  static int bring_shared_first(Triangle& s, Triangle& t) {
    int shared = 0;
    for (int i = 0; i < 3; ++i) {
      for (int j = shared; j < 3; ++j) {
        if (s[i] != t[j]) continue;
        std::swap(s[i], s[shared]);
        std::swap(t[j], t[shared]);
        ++shared;
        break;
      }
    }
    return shared;
  }

  const std::vector<Vec3>& positions_;
  const std::vector<Triangle>& triangles_;
  TriangleTree tree_;
  std::vector<int> leaves_;  // nodes
};

}  // namespace

std::vector<std::array<int, 2>> self_intersections(const std::vector<Vec3>& positions,
                                                   const std::vector<Triangle>& triangles) {
  check(static_cast<int>(positions.size()), triangles);
  const std::vector<Vec3> places = checked(positions);
  return Search(places, triangles).run();
}

}  // namespace flowskin::tracking
