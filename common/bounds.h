// The box around points.
#pragma once

#include <vector>

#include "common/vectors.h"

namespace flowskin {

/// The smallest box that holds the points; for none an empty one at the origin.
inline Box bounds(const std::vector<Vec3>& points) {
  if (points.empty()) return {};
  Box box{points.front(), points.front()};
  for (const Vec3& point : points) {
    box.min = box.min.cwiseMin(point);
    box.max = box.max.cwiseMax(point);
  }
  return box;
}

}  // namespace flowskin
