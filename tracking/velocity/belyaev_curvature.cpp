// Curvature by determinants [FMM13, A.2].
#include <cmath>

#include "tracking/velocity/curvature.h"

namespace flowskin::tracking {
namespace {

using Mat4 = Eigen::Matrix4d;

/// By the minors of the upper and the lower two rows.
double determinant(const Mat4& m) {
  const auto minor = [&m](int row, int a, int b) { return m(row, a) * m(row + 1, b) - m(row, b) * m(row + 1, a); };
  return minor(0, 0, 1) * minor(2, 2, 3) - minor(0, 0, 2) * minor(2, 1, 3) + minor(0, 0, 3) * minor(2, 1, 2) +
         minor(0, 1, 2) * minor(2, 0, 3) - minor(0, 1, 3) * minor(2, 0, 2) + minor(0, 2, 3) * minor(2, 0, 1);
}

/// The Hessian bordered by the gradient, or their changes.
Mat4 bordered(const Vec3& gradient, const Mat3& hessian) {
  Mat4 m;
  m << hessian, gradient, gradient.transpose(), 0;
  return m;
}

}  // namespace

Curvatures belyaev_curvatures(const Vec3& gradient, const Mat3& hessian) {
  const double g2 = gradient.squaredNorm();
  if (!(g2 > 0)) return {};
  const double g = std::sqrt(g2);
  const double sum = gradient.dot(hessian * gradient);
  return {-determinant(bordered(gradient, hessian)) / (g2 * g2), 0.5 * (hessian.trace() / g - sum / (g * g2))};
}

BelyaevCurvatureChange::BelyaevCurvatureChange(const Vec3& gradient, const Mat3& hessian)
    : gradient_(gradient), hessian_(hessian) {}

Curvatures BelyaevCurvatureChange::operator()(const Vec3& gradient_change, const Mat3& hessian_change) const {
  const double g2 = gradient_.squaredNorm();
  if (!(g2 > 0)) return {};
  const double g = std::sqrt(g2);
  const double slope_change = gradient_.dot(gradient_change);  // |grad f| d|grad f|

  const Mat4 m = bordered(gradient_, hessian_);
  const Mat4 dm = bordered(gradient_change, hessian_change);
  double determinant_change = 0;
  for (int row = 0; row < 4; ++row) {
    Mat4 replaced = m;
    replaced.row(row) = dm.row(row);
    determinant_change += determinant(replaced);
  }

  const double laplacian = hessian_.trace();
  const Vec3 sq = hessian_ * gradient_;
  const double sum = gradient_.dot(sq);
  const double sum_change = 2 * gradient_change.dot(sq) + gradient_.dot(hessian_change * gradient_);
  const double laplacian_part = (g2 * hessian_change.trace() - laplacian * slope_change) / (g * g2);
  const double sum_part = sum_change / (g * g2) - 3 * sum * slope_change / (g * g2 * g2);
  return {-determinant_change / (g2 * g2) + 4 * determinant(m) * slope_change / (g2 * g2 * g2),
          0.5 * (laplacian_part - sum_part)};
}

}  // namespace flowskin::tracking
