#include "tracking/mesh/triangle_tree.h"

#include <algorithm>
#include <numeric>

namespace flowskin::tracking {
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

}  // namespace

Box bounding_box(const std::vector<Vec3>& positions, const Triangle& triangle) {
  const Vec3 &a = positions[triangle[0]], &b = positions[triangle[1]], &c = positions[triangle[2]];
  return {a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
}

TriangleTree::TriangleTree(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles)
    : order_(triangles.size()) {
  if (triangles.empty()) return;
  std::iota(order_.begin(), order_.end(), 0);
  std::vector<Vec3> centers(triangles.size());
  std::vector<Box> boxes(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    centers[t] = (positions[triangles[t][0]] + positions[triangles[t][1]] + positions[triangles[t][2]]) / 3;
    boxes[t] = bounding_box(positions, triangles[t]);
  }
  const int count = static_cast<int>(triangles.size());
  nodes_.resize(node_count(count));
#pragma omp parallel
#pragma omp single
  build(0, 0, count, centers, boxes);
  boxes_.reserve(boxes.size());
  for (const int t : order_) boxes_.push_back(boxes[t]);
}

void TriangleTree::build(int index, int begin, int end, const std::vector<Vec3>& centers,
                         const std::vector<Box>& boxes) {
  Node node{boxes[order_[begin]], begin, end, -1};
  Vec3 low = centers[order_[begin]], high = low;
  for (int i = begin; i < end; ++i) {
    const Box& box = boxes[order_[i]];
    node.box = {node.box.low.cwiseMin(box.low), node.box.high.cwiseMax(box.high)};
    low = low.cwiseMin(centers[order_[i]]);
    high = high.cwiseMax(centers[order_[i]]);
  }
  const int middle = begin + (end - begin) / 2;
  const bool is_leaf = end - begin <= kLeafSize;
  if (!is_leaf) node.right = index + 1 + node_count(middle - begin);
  nodes_[index] = node;
  if (is_leaf) return;

  int axis = 0;
  (high - low).maxCoeff(&axis);
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, [&](int s, int t) {
    return centers[s][axis] != centers[t][axis] ? centers[s][axis] < centers[t][axis] : s < t;
  });
#pragma omp task if (end - begin > kTaskSize) shared(centers, boxes)
  build(index + 1, begin, middle, centers, boxes);
  build(node.right, middle, end, centers, boxes);
#pragma omp taskwait
}

}  // namespace flowskin::tracking
