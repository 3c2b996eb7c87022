// Points, vectors, boxes and triangles in space.
#pragma once

#include <Eigen/Core>
#include <array>

namespace flowskin {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

/// Indices of three corners, counter-clockwise seen from outside.
using Triangle = std::array<int, 3>;

/// A box along the axes, in any unit of length; it includes its border.
struct Box {
  Vec3 min = Vec3::Zero(), max = Vec3::Zero();

  bool overlaps(const Box& other) const {
    // All six comparisons are made: a branch for each would cost more.
    int count = 0;
    for (int axis = 0; axis < 3; ++axis)
      count += static_cast<int>(min[axis] <= other.max[axis]) + static_cast<int>(other.min[axis] <= max[axis]);
    return count == 6;
  }
  /// Square of the distance of a point to the box; 0 inside.
  double squared_distance(const Vec3& x) const { return (x - x.cwiseMax(min).cwiseMin(max)).squaredNorm(); }
};

}  // namespace flowskin
