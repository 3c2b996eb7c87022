// Gaussian and mean curvature of an implicit surface and how they change with the field.
#pragma once

#include "tracking/particles.h"

namespace flowskin::tracking {

/// Signs: with f > 0 inside and the normal n = grad f / |grad f| pointing into the fluid, the mean curvature of a
/// convex body is negative (ball of radius R: K = 1 / R^2, H = -1 / R); see kappa(u) = -u^T Hess f u / |grad f| in
/// [FMM13, Eq. 6], whose mean is -H.
struct Curvatures {
  double gaussian = 0;  ///< K (1/m^2)
  double mean = 0;      ///< H (1/m)
};

/// Kanatani's form [FMM13, Eq. 9]: K = q^T adj(S) q / |q|^4, H = (|q|^2 tr S - q^T S q) / (2 |q|^3) with q the gradient
/// and S the Hessian. Zero where the gradient is zero.
Curvatures curvatures(const Vec3& gradient, const Mat3& hessian);

/// Derivative of K and H with respect to the gradient and the Hessian.
class CurvatureChange {
 public:
  CurvatureChange(const Vec3& gradient, const Mat3& hessian);
  /// Change of K and H for a small change of the gradient and the (symmetric) Hessian: a derivative along x, y, z, or
  /// t.
  Curvatures operator()(const Vec3& gradient_change, const Mat3& hessian_change) const {
    return {gaussian_by_gradient_.dot(gradient_change) + gaussian_by_hessian_.cwiseProduct(hessian_change).sum(),
            mean_by_gradient_.dot(gradient_change) + mean_by_hessian_.cwiseProduct(hessian_change).sum()};
  }

 private:
  Vec3 gaussian_by_gradient_ = Vec3::Zero(), mean_by_gradient_ = Vec3::Zero();
  Mat3 gaussian_by_hessian_ = Mat3::Zero(), mean_by_hessian_ = Mat3::Zero();
};

/// Belyaev's form [FMM13, A.2]: K = -det M / |q|^4 with M the Hessian bordered by the gradient. Zero where the gradient
/// is zero.
Curvatures belyaev_curvatures(const Vec3& gradient, const Mat3& hessian);

/// Change of Belyaev's K and H by the formulas of [FMM13, A.2] as corrected: d det M is the sum of four determinants,
/// each with one row of M replaced by its change.
class BelyaevCurvatureChange {
 public:
  BelyaevCurvatureChange(const Vec3& gradient, const Mat3& hessian);
  /// See CurvatureChange.
  Curvatures operator()(const Vec3& gradient_change, const Mat3& hessian_change) const;

 private:
  Vec3 gradient_;
  Mat3 hessian_;
};

}  // namespace flowskin::tracking
