// Where a line along x crosses a triangle: what tests of inside and outside count.
#pragma once

#include <algorithm>
#include <optional>

#include "common/vectors.h"

namespace flowskin::sph {

/// A crossing at x (m); sign 1 or -1 by the side of the triangle that the line comes from.
struct RowCrossing {
  double x;
  int sign;
};

/// Is (y, z) left of the edge a -> b seen along x? The sum is done from the lower end to the upper one whatever the
/// direction, so two triangles that share an edge always agree and a row never slips between them.
inline bool left_of(const Vec3& a, const Vec3& b, double y, double z) {
  const bool swap = std::lexicographical_compare(b.data(), b.data() + 3, a.data(), a.data() + 3);
  const Vec3 &p = swap ? b : a, &q = swap ? a : b;
  const bool left = (q.y() - p.y()) * (z - p.z()) - (q.z() - p.z()) * (y - p.y()) >= 0;
  return left != swap;
}

/// Where the line along x through (y, z) crosses a triangle.
inline std::optional<RowCrossing> cross_row(const Vec3& a, const Vec3& b, const Vec3& c, double y, double z) {
  const bool ab = left_of(a, b, y, z), bc = left_of(b, c, y, z), ca = left_of(c, a, y, z);
  if (ab != bc || bc != ca) return std::nullopt;
  // Plane of the triangle solved for x.
  const double ny = (b.z() - a.z()) * (c.x() - a.x()) - (b.x() - a.x()) * (c.z() - a.z());
  const double nz = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
  const double nx = (b.y() - a.y()) * (c.z() - a.z()) - (b.z() - a.z()) * (c.y() - a.y());
  if (nx == 0) return std::nullopt;
  return RowCrossing{a.x() - (ny * (y - a.y()) + nz * (z - a.z())) / nx, ab ? 1 : -1};
}

}  // namespace flowskin::sph
