// On which side a point lies: decided exactly.
#pragma once

#include <cmath>

#include "common/vectors.h"

namespace flowskin {

/// The coordinates for which the signs below are exact: 0, or from 1e-60 to 1e60 in size. There neither overflow nor
/// underflow can spoil a product of three differences.
inline constexpr double kSmallestCoordinate = 1e-60, kLargestCoordinate = 1e60;

namespace exact {
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
int orientation(const Vec2& a, const Vec2& b, const Vec2& c);
}  // namespace exact

inline int sign_of(double value) { return (value > 0) - (value < 0); }

/// Sign of the determinant of (a - d, b - d, c - d): 1 where d lies behind the triangle abc, so that a, b, c run
/// clockwise seen from it; -1 where it lies before it; 0 where the four points lie in a plane. Never wrong: where
/// rounding could have changed the sign of the sum, it is worked out exactly.
///
/// The sum in doubles carries at most eight relative rounding errors of 2^-53 for each of its products of three (three
/// differences, two products, one sum of the minor, two sums of the minors); the bound below is twice as large, which
/// covers their products and the rounding of the bound itself. A fused multiply-add only leaves roundings out.
inline int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = a - d, v = b - d, w = c - d;
  const double vw0 = v[1] * w[2], wv0 = v[2] * w[1];
  const double vw1 = v[2] * w[0], wv1 = v[0] * w[2];
  const double vw2 = v[0] * w[1], wv2 = v[1] * w[0];
  const double sum = u[0] * (vw0 - wv0) + u[1] * (vw1 - wv1) + u[2] * (vw2 - wv2);
  const double size = std::abs(u[0]) * (std::abs(vw0) + std::abs(wv0)) +
                      std::abs(u[1]) * (std::abs(vw1) + std::abs(wv1)) +
                      std::abs(u[2]) * (std::abs(vw2) + std::abs(wv2));
  constexpr double bound = 0x1p-49;
  if (std::abs(sum) > bound * size) return sign_of(sum);
  return size == 0 ? 0 : exact::orientation(a, b, c, d);
}

/// Sign of the area of abc: 1 where they run counter-clockwise, 0 where they lie on a line. Never wrong.
/// The sum in doubles carries at most four relative errors of 2^-53 for each product.
inline int orientation(const Vec2& a, const Vec2& b, const Vec2& c) {
  const double left = (a[0] - c[0]) * (b[1] - c[1]), right = (a[1] - c[1]) * (b[0] - c[0]);
  const double sum = left - right, size = std::abs(left) + std::abs(right);
  constexpr double bound = 0x1p-50;
  if (std::abs(sum) > bound * size) return sign_of(sum);
  return size == 0 ? 0 : exact::orientation(a, b, c);
}

}  // namespace flowskin
