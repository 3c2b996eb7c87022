#include "tracking/mesh/closest_point.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "tracking/mesh/mesh_measures.h"

namespace flowskin::tracking {
namespace {

constexpr int kLeafSize = 4;

double box_distance(const Vec3& x, const Vec3& low, const Vec3& high) {
  return (x - x.cwiseMax(low).cwiseMin(high)).norm();
}

// Weights of the point of the plane of abc that is closest to x; false where it lies outside the triangle, or where
// that has no area.
bool weights_in_plane(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c, std::array<double, 3>& weights) {
  const Vec3 normal = (b - a).cross(c - a);
  const double squared = normal.squaredNorm();
  if (squared <= 0) return false;
  weights[1] = (x - a).cross(c - a).dot(normal) / squared;
  weights[2] = (b - a).cross(x - a).dot(normal) / squared;
  weights[0] = 1 - weights[1] - weights[2];
  return std::min({weights[0], weights[1], weights[2]}) >= 0;
}

// Weights of the closest point of a triangle, and the distance to it.
double closest_on_triangle(const Vec3& x, const std::array<Vec3, 3>& corners, std::array<double, 3>& weights) {
  if (weights_in_plane(x, corners[0], corners[1], corners[2], weights)) {
    return (weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2] - x).norm();
  }
  double best = -1;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const Vec3 side = corners[j] - corners[i];
    const double squared = side.squaredNorm();
    const double t = squared > 0 ? std::clamp((x - corners[i]).dot(side) / squared, 0.0, 1.0) : 0.0;
    const double distance = (corners[i] + t * side - x).norm();
    if (best >= 0 && distance >= best) continue;
    best = distance;
    weights = {0, 0, 0};
    weights[i] = 1 - t;
    weights[j] = t;
  }
  return best;
}

}  // namespace

ClosestPointTree::ClosestPointTree(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles)
    : positions_(positions), triangles_(triangles), order_(triangles.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  std::vector<Vec3> centers(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    centers[t] = (positions[triangles[t][0]] + positions[triangles[t][1]] + positions[triangles[t][2]]) / 3;
  }
  nodes_.reserve(triangles.size());
  if (!triangles.empty()) build(0, static_cast<int>(triangles.size()), centers);
}

int ClosestPointTree::build(int begin, int end, const std::vector<Vec3>& centers) {
  const int index = static_cast<int>(nodes_.size());
  Node node{positions_[triangles_[order_[begin]][0]], positions_[triangles_[order_[begin]][0]], begin, end, -1};
  Vec3 low = centers[order_[begin]], high = low;
  for (int i = begin; i < end; ++i) {
    for (int vertex : triangles_[order_[i]]) {
      node.low = node.low.cwiseMin(positions_[vertex]);
      node.high = node.high.cwiseMax(positions_[vertex]);
    }
    low = low.cwiseMin(centers[order_[i]]);
    high = high.cwiseMax(centers[order_[i]]);
  }
  nodes_.push_back(node);
  if (end - begin <= kLeafSize) return index;

  int axis = 0;
  (high - low).maxCoeff(&axis);
  const int middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, [&](int s, int t) {
    return centers[s][axis] != centers[t][axis] ? centers[s][axis] < centers[t][axis] : s < t;
  });
  build(begin, middle, centers);
  const int right = build(middle, end, centers);
  nodes_[index].right = right;
  return index;
}

void ClosestPointTree::search(int index, const Vec3& x, const Vec3& normal, double cosine, MeshPoint& best) const {
  const Node& node = nodes_[index];
  if (node.right >= 0) {
    const int left = index + 1;
    const double to_left = box_distance(x, nodes_[left].low, nodes_[left].high);
    const double to_right = box_distance(x, nodes_[node.right].low, nodes_[node.right].high);
    const bool left_first = to_left <= to_right;
    if (std::min(to_left, to_right) < best.distance) {
      search(left_first ? left : node.right, x, normal, cosine, best);
    }
    if (std::max(to_left, to_right) < best.distance) {
      search(left_first ? node.right : left, x, normal, cosine, best);
    }
    return;
  }
  for (int i = node.begin; i < node.end; ++i) {
    const Triangle& triangle = triangles_[order_[i]];
    if (!normal.isZero(0)) {
      const Vec3 area = doubled_area_vector(positions_, triangle);
      if (!(area.dot(normal) > cosine * area.norm() * normal.norm())) continue;
    }
    std::array<double, 3> weights{};
    const double distance =
        closest_on_triangle(x, {positions_[triangle[0]], positions_[triangle[1]], positions_[triangle[2]]}, weights);
    if (distance < best.distance) best = {order_[i], weights, distance};
  }
}

MeshPoint ClosestPointTree::closest(const Vec3& x, double reach, const Vec3& normal, double cosine) const {
  MeshPoint best;
  best.distance = reach;
  if (!nodes_.empty()) search(0, x, normal, cosine, best);
  return best;
}

}  // namespace flowskin::tracking
