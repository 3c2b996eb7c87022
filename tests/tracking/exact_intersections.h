// A second, slow route to intersecting triangles: one triangle is cut down by the half spaces of the other, in whole
// numbers. Nothing of it is shared with the library.
#pragma once

#include <array>
#include <vector>

#include "tracking/mesh/surface_mesh.h"

namespace flowskin::tracking::test {

__extension__ using Whole = __int128;
using WholePoint = std::array<long long, 3>;
using WholeTriangle = std::array<WholePoint, 3>;

/// A point (x, y, z) / w with w > 0; or the half space of the points p with x p.x + y p.y + z p.z + w p.w >= 0.
/// For corners with coordinates up to 8, no product below is longer than 103 bits.
using Homogeneous = std::array<Whole, 4>;

inline Homogeneous in_lowest_terms(Homogeneous x) {
  Whole divisor = 0;
  for (Whole value : x) {
    for (value = value < 0 ? -value : value; value != 0;) {  // Euclid
      const Whole rest = divisor % value;
      divisor = value;
      value = rest;
    }
  }
  for (Whole& value : x) value /= divisor == 0 ? 1 : divisor;
  return x;
}

inline Homogeneous opposite(Homogeneous h) {
  for (Whole& value : h) value = -value;
  return h;
}

inline WholePoint minus(const WholePoint& a, const WholePoint& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline WholePoint times(const WholePoint& a, const WholePoint& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline bool is_zero(const WholePoint& a) { return a == WholePoint{0, 0, 0}; }

/// The points x with normal . (x - origin) >= 0.
inline Homogeneous half_space(const WholePoint& n, const WholePoint& origin) {
  return in_lowest_terms({n[0], n[1], n[2], -(n[0] * origin[0] + n[1] * origin[1] + n[2] * origin[2])});
}

/// The half spaces whose common part is the hull of the corners.
inline std::vector<Homogeneous> half_spaces(const WholeTriangle& t) {
  std::vector<Homogeneous> all;
  const auto plane = [&](const WholePoint& normal, const WholePoint& origin) {
    if (is_zero(normal)) return;
    all.push_back(half_space(normal, origin));
    all.push_back(opposite(all.back()));
  };
  const WholePoint normal = times(minus(t[1], t[0]), minus(t[2], t[0]));
  if (!is_zero(normal)) {
    plane(normal, t[0]);
    for (int i = 0; i < 3; ++i) all.push_back(half_space(times(normal, minus(t[(i + 1) % 3], t[i])), t[i]));
    return all;
  }
  // On a line: across each axis it stays on the line, and between its ends.
  WholePoint low = t[0], high = t[0];
  for (const WholePoint& corner : t) {
    if (corner < low) low = corner;
    if (high < corner) high = corner;
  }
  const WholePoint along = minus(high, low);
  const std::array<WholePoint, 3> axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  if (is_zero(along)) {
    for (const WholePoint& axis : axes) plane(axis, low);
    return all;
  }
  for (const WholePoint& axis : axes) plane(times(along, axis), low);
  all.push_back(half_space(along, low));
  all.push_back(half_space(minus(low, high), high));
  return all;
}

inline Whole side(const Homogeneous& h, const Homogeneous& p) {
  return h[0] * p[0] + h[1] * p[1] + h[2] * p[2] + h[3] * p[3];
}

/// The part of a convex polygon in a half space [Sutherland and Hodgman 1974].
inline std::vector<Homogeneous> clipped(const std::vector<Homogeneous>& polygon, const Homogeneous& h) {
  std::vector<Homogeneous> result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Homogeneous &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const Whole at_p = side(h, p), at_q = side(h, q);
    if (at_p >= 0) result.push_back(p);
    if ((at_p < 0 && at_q > 0) || (at_p > 0 && at_q < 0)) {
      Homogeneous crossing;
      for (int k = 0; k < 4; ++k) crossing[k] = at_q * p[k] - at_p * q[k];
      crossing = in_lowest_terms(crossing);
      result.push_back(crossing[3] < 0 ? opposite(crossing) : crossing);
    }
  }
  return result;
}

/// Whether a point is on the segment pq.
inline bool on_segment(const Homogeneous& x, const WholePoint& p, const WholePoint& q) {
  for (const Homogeneous& h : half_spaces({p, q, q})) {
    if (side(h, x) < 0) return false;
  }
  return true;
}

/// As self_intersections says it, by all pairs.
inline std::vector<std::array<int, 2>> all_intersections(const std::vector<WholePoint>& points,
                                                         const std::vector<Triangle>& triangles) {
  std::vector<std::array<int, 2>> pairs;
  for (int s = 0; s < static_cast<int>(triangles.size()); ++s) {
    for (int t = s + 1; t < static_cast<int>(triangles.size()); ++t) {
      std::vector<Homogeneous> polygon;
      std::vector<int> shared;
      for (int vertex : triangles[s]) {
        const auto& [x, y, z] = points[vertex];
        polygon.push_back({x, y, z, 1});
        for (int other : triangles[t]) {
          if (other == vertex) shared.push_back(vertex);
        }
      }
      const Triangle& other = triangles[t];
      for (const Homogeneous& h : half_spaces({points[other[0]], points[other[1]], points[other[2]]})) {
        polygon = clipped(polygon, h);
      }
      // The corners of the common part are allowed where they are on what is shared by index.
      bool meet = shared.size() == 3;
      for (const Homogeneous& corner : polygon) {
        meet = meet || shared.empty() || !on_segment(corner, points[shared.front()], points[shared.back()]);
      }
      if (meet) pairs.push_back({s, t});
    }
  }
  return pairs;
}

}  // namespace flowskin::tracking::test
