// Triangles cut to a box.
#pragma once

#include <vector>

#include "common/vectors.h"

namespace flowskin::sph {

/// The part of a convex polygon on one side (1: above, -1: below) of a plane across an axis [Sutherland and Hodgman
/// 1974]. Polygons that share an edge still share it when both are cut.
std::vector<Vec3> cut(const std::vector<Vec3>& polygon, int axis, double plane, double side);

/// The part of a convex polygon inside the box; fewer than three corners: none.
std::vector<Vec3> clip(std::vector<Vec3> polygon, const Box& box);

/// The whole of space.
Box everywhere();

/// Whether p lies in the box.
inline bool contains(const Box& box, const Vec3& p) {
  return (p.array() >= box.min.array()).all() && (p.array() <= box.max.array()).all();
}

}  // namespace flowskin::sph
