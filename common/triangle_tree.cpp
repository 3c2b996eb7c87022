#include "common/triangle_tree.h"

#include <algorithm>

namespace flowskin {
namespace {

constexpr int kLeafSize = 4;
constexpr int kTaskSize = 4096;  // triangles that are worth a task of their own

// Nodes of a tree over so many triangles.
int node_count(int triangles) {
  if (triangles <= kLeafSize) return 1;
  const int half = triangles / 2, rest = triangles - half;
  const int left = node_count(half);
  return 1 + left + (rest == half ? left : node_count(rest));
}

Box united(const Box& a, const Box& b) { return {a.min.cwiseMin(b.min), a.max.cwiseMax(b.max)}; }

}  // namespace

Box bounding_box(const std::vector<Vec3>& positions, const Triangle& triangle) {
  const Vec3 &a = positions[triangle[0]], &b = positions[triangle[1]], &c = positions[triangle[2]];
  return {a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
}

TriangleTree::TriangleTree(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles) {
  const int count = static_cast<int>(triangles.size());
  if (count == 0) return;
  order_.resize(count);
  boxes_.resize(count);
  nodes_.resize(node_count(count));
  std::vector<Item> items(count);
#pragma omp parallel
  {
#pragma omp for schedule(static)
    for (int t = 0; t < count; ++t) {
      const auto& [a, b, c] = triangles[t];
      items[t] = {(positions[a] + positions[b] + positions[c]) / 3, t};
    }
#pragma omp single
    build(0, 0, count, positions, triangles, items);
  }
}

void TriangleTree::build(int index, int begin, int end, const std::vector<Vec3>& positions,
                         const std::vector<Triangle>& triangles, std::vector<Item>& items) {
  Node& node = nodes_[index];
  node.begin = begin;
  node.end = end;
  if (end - begin <= kLeafSize) {
    node.right = -1;
    for (int i = begin; i < end; ++i) {
      order_[i] = items[i].triangle;
      boxes_[i] = bounding_box(positions, triangles[order_[i]]);
      node.box = i == begin ? boxes_[i] : united(node.box, boxes_[i]);
    }
    return;
  }

  Vec3 low = items[begin].center, high = low;
  for (int i = begin; i < end; ++i) {
    low = low.cwiseMin(items[i].center);
    high = high.cwiseMax(items[i].center);
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  const int middle = begin + (end - begin) / 2;
  std::nth_element(
      items.begin() + begin, items.begin() + middle, items.begin() + end, [axis](const Item& s, const Item& t) {
        return s.center[axis] != t.center[axis] ? s.center[axis] < t.center[axis] : s.triangle < t.triangle;
      });
  const int left = index + 1, right = left + node_count(middle - begin);
  node.right = right;
#pragma omp task if (end - begin > kTaskSize) shared(positions, triangles, items)
  build(left, begin, middle, positions, triangles, items);
  build(right, middle, end, positions, triangles, items);
#pragma omp taskwait
  node.box = united(nodes_[left].box, nodes_[right].box);
}

}  // namespace flowskin
