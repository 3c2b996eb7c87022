#include "tracking/mesh/triangle_pair.h"

#include <algorithm>
#include <initializer_list>
#include <utility>

#include "common/orientation.h"

namespace flowskin::tracking {
namespace {

// Points in a common plane are told apart by their projection along a coordinate axis that does not lie in this plane:
// it keeps which point is on which line, and between which others.
constexpr int kNoAxis = -1;

Vec2 projected(const Vec3& x, int axis) { return {x[(axis + 1) % 3], x[(axis + 2) % 3]}; }

int orientation_along(int axis, const Vec3& a, const Vec3& b, const Vec3& c) {
  return orientation(projected(a, axis), projected(b, axis), projected(c, axis));
}

// An axis along which the triangle is not seen as a line; kNoAxis where its corners lie on a line.
int axis_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  for (int axis = 0; axis < 3; ++axis) {
    if (orientation_along(axis, a, b, c) != 0) return axis;
  }
  return kNoAxis;
}
int axis_of(const Corners& t) { return axis_of(t[0], t[1], t[2]); }

// Points on a line are in the same order along it as the words in a dictionary.
bool before(const Vec3& x, const Vec3& y) {
  return std::lexicographical_compare(x.data(), x.data() + 3, y.data(), y.data() + 3);
}

// From the first to the last of some points on a line.
struct Interval {
  Vec3 low, high;
  Interval(std::initializer_list<Vec3> points) : low(std::min(points, before)), high(std::max(points, before)) {}
};

// What two intervals of a line have in common; its ends are the wrong way round where that is nothing.
std::pair<Vec3, Vec3> common(const Interval& a, const Interval& b) {
  return {std::max(a.low, b.low, before), std::min(a.high, b.high, before)};
}

bool in_box_of(const Vec3& x, const Vec3& p, const Vec3& q) {
  return (x.array() >= p.cwiseMin(q).array()).all() && (x.array() <= p.cwiseMax(q).array()).all();
}

// Segments pq and rs in a plane across the axis.
bool segments_meet_along(int axis, const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
  const int to_p = orientation_along(axis, r, s, p), to_q = orientation_along(axis, r, s, q);
  const int to_r = orientation_along(axis, p, q, r), to_s = orientation_along(axis, p, q, s);
  if (to_p * to_q < 0 && to_r * to_s < 0) return true;
  return (to_p == 0 && in_box_of(p, r, s)) || (to_q == 0 && in_box_of(q, r, s)) || (to_r == 0 && in_box_of(r, p, q)) ||
         (to_s == 0 && in_box_of(s, p, q));
}

bool segments_meet(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
  if (orientation(p, q, r, s) != 0) return false;  // not in a plane
  for (const int axis : {axis_of(p, q, r), axis_of(p, q, s), axis_of(p, r, s), axis_of(q, r, s)}) {
    if (axis != kNoAxis) return segments_meet_along(axis, p, q, r, s);
  }
  const auto [low, high] = common({p, q}, {r, s});
  return !before(high, low);
}

bool all_of_one_sign(int a, int b, int c) { return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0); }

// A point of the plane of a triangle that has an area, seen along the axis.
bool covers(int axis, const Corners& t, const Vec3& x) {
  return all_of_one_sign(orientation_along(axis, t[0], t[1], x), orientation_along(axis, t[1], t[2], x),
                         orientation_along(axis, t[2], t[0], x));
}

bool segment_meets_border(const Vec3& p, const Vec3& q, const Corners& t) {
  return segments_meet(p, q, t[0], t[1]) || segments_meet(p, q, t[1], t[2]) || segments_meet(p, q, t[2], t[0]);
}

bool segment_meets_triangle(const Vec3& p, const Vec3& q, const Corners& t) {
  const int side_p = orientation(t[0], t[1], t[2], p), side_q = orientation(t[0], t[1], t[2], q);
  if (side_p * side_q > 0) return false;
  if (side_p == 0 && side_q == 0) {  // in the plane of the triangle, or that has no area
    const int axis = axis_of(t);
    return (axis != kNoAxis && covers(axis, t, p)) || segment_meets_border(p, q, t);
  }
  // The line pq crosses the plane in one point, which is on the segment.
  return all_of_one_sign(orientation(p, q, t[0], t[1]), orientation(p, q, t[1], t[2]), orientation(p, q, t[2], t[0]));
}

bool point_in_triangle(const Vec3& x, const Corners& t) { return segment_meets_triangle(x, x, t); }

// Whether points are on the same side of the plane of a triangle, and none in it.
template <class... Points>
bool strictly_on_one_side(const Corners& t, const Vec3& first, const Points&... others) {
  const int side = orientation(t[0], t[1], t[2], first);
  return side != 0 && ((orientation(t[0], t[1], t[2], others) == side) && ...);
}

Interval interval_of(const Corners& t) { return {t[0], t[1], t[2]}; }

// `flat`, whose corners lie on a line, is made of the segments from its first corner to the two others; `t` has an
// area. Outside their common first corner, such a segment meets t where its end is in t, or where it crosses the
// opposite edge.
bool flat_meets_beyond_corner(const Corners& flat, const Corners& t) {
  const Vec3& corner = flat[0];
  for (const Vec3& end : {flat[1], flat[2]}) {
    if (end != corner && (point_in_triangle(end, t) || segments_meet(corner, end, t[1], t[2]))) return true;
  }
  return false;
}

}  // namespace

// Where two convex sets meet, the border of one meets the other.
bool triangles_meet(const Corners& first, const Corners& second) {
  if (strictly_on_one_side(second, first[0], first[1], first[2]) ||
      strictly_on_one_side(first, second[0], second[1], second[2])) {
    return false;
  }
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    if (segment_meets_triangle(first[i], first[j], second)) return true;
    if (segment_meets_triangle(second[i], second[j], first)) return true;
  }
  return false;
}

// A ray from the common corner through another common point leaves one of the triangles first, through the edge
// opposite the corner, at a point of the other.
bool triangles_meet_beyond_corner(const Corners& first, const Corners& second) {
  if (strictly_on_one_side(second, first[1], first[2]) || strictly_on_one_side(first, second[1], second[2])) {
    return false;
  }
  const bool first_is_flat = axis_of(first) == kNoAxis, second_is_flat = axis_of(second) == kNoAxis;
  if (first_is_flat && second_is_flat) {
    for (const Vec3& x : {second[1], second[2]}) {
      for (const Vec3& y : {first[1], first[2]}) {
        if (axis_of(first[0], x, y) != kNoAxis) return false;  // on two lines, which cross in the corner
      }
    }
    const auto [low, high] = common(interval_of(first), interval_of(second));
    return low != high;
  }
  if (first_is_flat) return flat_meets_beyond_corner(first, second);
  if (second_is_flat) return flat_meets_beyond_corner(second, first);
  return segment_meets_triangle(first[1], first[2], second) || segment_meets_triangle(second[1], second[2], first);
}

bool triangles_meet_beyond_edge(const Corners& first, const Corners& second) {
  if (orientation(first[0], first[1], first[2], second[2]) != 0) return false;  // two half planes meet in their edge
  const int axis = axis_of(first);
  if (axis != kNoAxis) {
    // In a plane: the third corners are on the same side of the edge. Where the second one has no area, its third
    // corner is on the line of the edge, and the first triangle has no more of this line than the edge.
    return orientation_along(axis, first[0], first[1], first[2]) ==
           orientation_along(axis, first[0], first[1], second[2]);
  }
  if (axis_of(second) != kNoAxis || axis_of(first[0], first[2], second[2]) != kNoAxis) return false;
  const auto [low, high] = common(interval_of(first), interval_of(second));
  const Interval edge{first[0], first[1]};
  return low != edge.low || high != edge.high;
}

}  // namespace flowskin::tracking
