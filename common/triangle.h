// Points and triangles.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "common/vectors.h"

namespace flowskin {

inline Vec3 closest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 edge = b - a;
  const double length2 = edge.squaredNorm();
  return length2 > 0 ? Vec3(a + std::clamp(edge.dot(p - a) / length2, 0.0, 1.0) * edge) : a;
}

/// The point of the triangle a, b, c nearest to p. `normal` is its unit normal.
inline Vec3 closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& normal) {
  const Vec3 foot = p - normal.dot(p - a) * normal;
  const bool inside = normal.dot((b - a).cross(foot - a)) >= 0 && normal.dot((c - b).cross(foot - b)) >= 0 &&
                      normal.dot((a - c).cross(foot - c)) >= 0;
  if (inside) return foot;
  Vec3 best = closest_on_segment(p, a, b);
  for (const Vec3& q : {closest_on_segment(p, b, c), closest_on_segment(p, c, a)}) {
    if ((q - p).squaredNorm() < (best - p).squaredNorm()) best = q;
  }
  return best;
}

/// Twice the area vector of a triangle (m^2), along the outward normal.
inline Vec3 doubled_area_vector(const std::vector<Vec3>& positions, const Triangle& triangle) {
  const Vec3& a = positions[triangle[0]];
  return (positions[triangle[1]] - a).cross(positions[triangle[2]] - a);
}

inline Vec3 triangle_center(const std::vector<Vec3>& positions, const Triangle& triangle) {
  return (positions[triangle[0]] + positions[triangle[1]] + positions[triangle[2]]) / 3;
}

}  // namespace flowskin
