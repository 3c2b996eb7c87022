// Points and triangles.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>

#include "sph/geometry/triangle_mesh.h"

namespace flowskin::sph {

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

}  // namespace flowskin::sph
