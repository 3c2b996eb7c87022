#include "common/closest_point.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "common/triangle.h"

namespace flowskin {
namespace {

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

}  // namespace

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

ClosestPointTree::ClosestPointTree(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles)
    : positions_(positions), triangles_(triangles), tree_(positions, triangles) {}

void ClosestPointTree::search(int index, const Query& query, MeshPoint& best) const {
  const TriangleTree::Node& node = tree_.nodes()[index];
  if (node.right >= 0) {
    const int left = index + 1;
    const double to_left = tree_.nodes()[left].box.squared_distance(query.x);
    const double to_right = tree_.nodes()[node.right].box.squared_distance(query.x);
    const bool left_first = to_left <= to_right;
    const auto worthwhile = [&](double squared) {
      return squared < best.distance * best.distance && (best.triangle < 0 || best.distance > query.near_enough);
    };
    if (worthwhile(std::min(to_left, to_right))) search(left_first ? left : node.right, query, best);
    if (worthwhile(std::max(to_left, to_right))) search(left_first ? node.right : left, query, best);
    return;
  }
  for (int i = node.begin; i < node.end; ++i) {
    if (tree_.boxes()[i].squared_distance(query.x) >= best.distance * best.distance) continue;
    const int number = tree_.order()[i];
    const Triangle& triangle = triangles_[number];
    if (!query.normal.isZero(0)) {
      const Vec3 area = doubled_area_vector(positions_, triangle);
      if (!(area.dot(query.normal) > query.cosine * area.norm() * query.normal.norm())) continue;
    }
    std::array<double, 3> weights{};
    const double distance = closest_on_triangle(
        query.x, {positions_[triangle[0]], positions_[triangle[1]], positions_[triangle[2]]}, weights);
    if (distance < best.distance) best = {number, weights, distance};
    if (best.triangle >= 0 && best.distance <= query.near_enough) return;
  }
}

MeshPoint ClosestPointTree::closest(const Vec3& x, double reach, const Vec3& normal, double cosine) const {
  MeshPoint best;
  best.distance = reach;
  if (!tree_.nodes().empty()) search(0, {x, normal, cosine, -1}, best);
  return best;
}

bool ClosestPointTree::is_near(const Vec3& x, double reach, const Vec3& normal, double cosine) const {
  MeshPoint best;
  best.distance = reach;
  if (!tree_.nodes().empty()) search(0, {x, normal, cosine, reach}, best);
  return best.triangle >= 0;
}

double ClosestPointTree::distance(const Vec3& x, double near_enough) const {
  MeshPoint best;
  best.distance = std::numeric_limits<double>::infinity();
  if (!tree_.nodes().empty()) search(0, {x, Vec3::Zero(), 0, near_enough}, best);
  return best.distance;
}

}  // namespace flowskin
