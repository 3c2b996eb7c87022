// A surface point as the pointwise velocity methods see it: without units of length, in a frame of the tangent plane.
#pragma once

#include <Eigen/Core>

#include "tracking/field/implicit_field.h"
#include "tracking/field/jet.h"

namespace flowskin::tracking {

using Vec2 = Eigen::Vector2d;
using Mat2 = Eigen::Matrix2d;
using Mat32 = Eigen::Matrix<double, 3, 2>;

/// The jet in the units of the field's scale: for particles, lengths in effective radii and f in kernel weights.
/// Whatever a method weighs or damps in these quantities is the same in all units and at all sizes of a scene; only
/// time keeps its unit (s).
struct SurfacePoint {
  SurfacePoint(const MotionJet& jet, const FieldScale& scale);

  MotionJet jet;
  bool defined;          ///< The gradient is not zero; otherwise nothing below has a meaning.
  double slope = 0;      ///< |grad f|
  Vec3 normal;           ///< n = grad f / |grad f|; points into the fluid.
  Mat32 tangents;        ///< Two orthonormal directions of the tangent plane, any.
  Vec3 normal_velocity;  ///< -f_t grad f / |grad f|^2 [FMM13, Eq. 4]

  /// Derivative of the Hessian along v: the matrix with elements f_ijk v_k.
  Mat3 hessian_along(const Vec3& v) const { return v[0] * jet.third[0] + v[1] * jet.third[1] + v[2] * jet.third[2]; }
};

}  // namespace flowskin::tracking
