// Points far away from nearly all others, which must not decide what pictures show or how large a texture is.
#pragma once

#include <algorithm>
#include <vector>

#include "common/vectors.h"

namespace flowskin {

/// What pictures show around nearly all points, in spacings.
inline constexpr double kPictureMargin = 10;

/// Points without those far outside: farther beyond the box of nearly all (but for a hundredth at each side, or two)
/// than half of its longest edge and `margin` (m).
inline std::vector<Vec3> without_outliers(const std::vector<Vec3>& points, double margin) {
  constexpr std::size_t fewest = 8;
  if (points.size() < fewest) return points;
  const std::size_t skipped = std::max<std::size_t>(2, points.size() / 100);
  Vec3 low, high;
  std::vector<double> values(points.size());
  for (Eigen::Index k = 0; k < 3; ++k) {
    std::transform(points.begin(), points.end(), values.begin(), [&](const Vec3& x) { return x[k]; });
    const auto lower = values.begin() + static_cast<std::ptrdiff_t>(skipped);
    std::nth_element(values.begin(), lower, values.end());
    low[k] = *lower;
    const auto upper = values.end() - 1 - static_cast<std::ptrdiff_t>(skipped);
    std::nth_element(values.begin(), upper, values.end());
    high[k] = *upper;
  }
  const Vec3 reach = Vec3::Constant(0.5 * (high - low).maxCoeff() + margin);
  std::vector<Vec3> inside;
  for (const Vec3& x : points)
    if (((x - low + reach).array() >= 0).all() && ((high + reach - x).array() >= 0).all()) inside.push_back(x);
  return inside;
}

}  // namespace flowskin
