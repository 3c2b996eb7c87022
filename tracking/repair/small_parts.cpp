#include "tracking/repair/small_parts.h"

#include <Eigen/Geometry>
#include <cmath>

namespace flowskin::tracking {
namespace {

double volume_of_cone(const Triangle& triangle, const std::vector<Vec3>& positions, const Vec3& tip) {
  return (positions[triangle[0]] - tip).dot((positions[triangle[1]] - tip).cross(positions[triangle[2]] - tip)) / 6;
}

}  // namespace

bool make_ball(const std::vector<int>& vertices, const std::vector<Triangle>& triangles, double volume,
               std::vector<Vec3>& positions) {
  if (vertices.empty() || volume == 0) return false;
  Vec3 center = Vec3::Zero();
  for (int v : vertices) center += positions[v] / static_cast<double>(vertices.size());
  std::vector<Vec3> before;
  before.reserve(vertices.size());
  for (int v : vertices) before.push_back(positions[v]);
  const auto restored = [&] {
    for (std::size_t i = 0; i < vertices.size(); ++i) positions[vertices[i]] = before[i];
    return false;
  };
  for (int v : vertices) {
    const Vec3 ray = positions[v] - center;
    if (!(ray.norm() > 0)) return restored();
    positions[v] = center + ray.normalized();
  }
  // A polyhedron in a sphere of radius 1; its own volume, not that of the sphere, is scaled.
  double sum = 0;
  for (const Triangle& triangle : triangles) {
    const double cone = volume_of_cone(triangle, positions, center);
    if (!(cone * volume > 0)) return restored();
    sum += cone;
  }
  const double radius = std::cbrt(volume / sum);
  for (int v : vertices) positions[v] = center + radius * (positions[v] - center);
  return true;
}

}  // namespace flowskin::tracking
