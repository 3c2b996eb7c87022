#include "tracking/mesh/self_intersections.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "common/orientation.h"
#include "common/triangle_tree.h"
#include "tracking/mesh/triangle_pair.h"

namespace flowskin::tracking {
namespace {

using Pair = std::array<int, 2>;

// The positions as the exact predicates want them.
std::vector<Vec3> checked(std::vector<Vec3> positions) {
  for (std::size_t v = 0; v < positions.size(); ++v) {
    for (double& value : positions[v]) {
      if (!(std::abs(value) <= kLargestCoordinate)) {
        throw std::invalid_argument("vertex " + std::to_string(v) + " is not finite, or farther out than 1e60 m");
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

// Orders the corners of two triangles so that those they share come first, in the same order. Returns how many.
int bring_shared_first(Triangle& s, Triangle& t) {
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

// Whether the plane through `origin` across `direction` has the corners from number `first` on strictly on that side
// of it. The difference of two numbers is rounded once, so that the error is some 1e-15 of the lengths' product.
bool lies_beyond(const Corners& corners, int first, const Vec3& origin, const Vec3& direction) {
  constexpr double margin = 1e-14;
  const double size = direction.cwiseAbs().maxCoeff();
  bool beyond = true;
  for (int i = first; i < 3; ++i) {
    const Vec3 x = corners[i] - origin;
    beyond = beyond && x.dot(direction) > margin * size * x.cwiseAbs().sum();
  }
  return beyond;
}

// Whether a plane between two triangles tells that they have nothing in common but the first corner of both, if they
// share it. Nearly all pairs of a mesh are told apart by it. False: not known.
bool surely_apart(const Corners& s, const Corners& t, bool share_corner) {
  const Vec3 middle_s = (s[0] + s[1] + s[2]) / 3, middle_t = (t[0] + t[1] + t[2]) / 3;
  if (!share_corner) {
    const Vec3 between = (middle_s + middle_t) / 2, direction = middle_s - middle_t;
    return lies_beyond(s, 0, between, direction) && lies_beyond(t, 0, between, -direction);
  }
  const Vec3 direction = (middle_s - s[0]).normalized() - (middle_t - s[0]).normalized();
  return lies_beyond(s, 1, s[0], direction) && lies_beyond(t, 1, s[0], -direction);
}

class Search {
 public:
  Search(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles)
      : positions_(positions), triangles_(triangles), tree_(positions, triangles) {
    if (!tree_.nodes().empty()) add_jobs(0);
  }

  std::vector<Pair> run() const {
    std::vector<Pair> found;
#pragma omp parallel
    {
      std::vector<Pair> mine;
#pragma omp for schedule(dynamic, 4) nowait
      for (int i = 0; i < static_cast<int>(jobs_.size()); ++i) compare(jobs_[i][0], jobs_[i][1], mine);
#pragma omp critical(flowskin_self_intersections)
      found.insert(found.end(), mine.begin(), mine.end());
    }
    std::sort(found.begin(), found.end());
    return found;
  }

 private:
  using Node = TriangleTree::Node;
  static constexpr int kJobSize = 256;  // triangles

  // Pairs of nodes that together hold all pairs of triangles of a subtree.
  void add_jobs(int index) {
    const Node& node = tree_.nodes()[index];
    if (node.right < 0 || node.end - node.begin <= kJobSize) {
      jobs_.push_back({index, index});
      return;
    }
    add_jobs(index + 1);
    add_jobs(node.right);
    jobs_.push_back({index + 1, node.right});
  }

  // Compares all triangles of one subtree with all of another, or those of one among themselves.
  void compare(int first, int second, std::vector<Pair>& found) const {
    const Node &a = tree_.nodes()[first], &b = tree_.nodes()[second];
    if (!a.box.overlaps(b.box)) return;
    if (a.right < 0 && b.right < 0) {
      compare_leaves(a, b, found);
    } else if (first == second) {
      compare(first + 1, first + 1, found);
      compare(a.right, a.right, found);
      compare(first + 1, a.right, found);
    } else if (b.right < 0 || (a.right >= 0 && a.end - a.begin >= b.end - b.begin)) {
      compare(first + 1, second, found);
      compare(a.right, second, found);
    } else {
      compare(first, second + 1, found);
      compare(first, b.right, found);
    }
  }

  void compare_leaves(const Node& a, const Node& b, std::vector<Pair>& found) const {
    for (int i = a.begin; i < a.end; ++i) {
      for (int j = std::max(i + 1, b.begin); j < b.end; ++j) {
        if (!tree_.boxes()[i].overlaps(tree_.boxes()[j])) continue;
        const int s = tree_.order()[i], t = tree_.order()[j];
        if (triangles_intersect(positions_, triangles_[s], triangles_[t]))
          found.push_back({std::min(s, t), std::max(s, t)});
      }
    }
  }

  const std::vector<Vec3>& positions_;
  const std::vector<Triangle>& triangles_;
  TriangleTree tree_;
  std::vector<std::array<int, 2>> jobs_;  // nodes, the earlier one first
};

}  // namespace

bool triangles_intersect(std::span<const Vec3> positions, Triangle first, Triangle second) {
  const int shared = bring_shared_first(first, second);
  if (shared == 3) return true;
  const Corners s = {positions[first[0]], positions[first[1]], positions[first[2]]};
  const Corners t = {positions[second[0]], positions[second[1]], positions[second[2]]};
  if (shared == 2) return triangles_meet_beyond_edge(s, t);
  if (surely_apart(s, t, shared == 1)) return false;
  return shared == 1 ? triangles_meet_beyond_corner(s, t) : triangles_meet(s, t);
}

std::vector<std::array<int, 2>> self_intersections(const std::vector<Vec3>& positions,
                                                   const std::vector<Triangle>& triangles) {
  check(static_cast<int>(positions.size()), triangles);
  const std::vector<Vec3> places = checked(positions);
  return Search(places, triangles).run();
}

}  // namespace flowskin::tracking
