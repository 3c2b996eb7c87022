// What the field says about the motion of its neighbourhood, as rows of a least-squares problem.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "tracking/field/kernel_moments.h"
#include "tracking/field/neighborhoods.h"
#include "tracking/field/particle_field.h"
#include "tracking/velocity/surface_point.h"

namespace flowskin::tracking {

/// A motion y -> v + w x (y - x) near a point x; the parameters of its gradient are w.
struct RigidMotion {
  static constexpr int parameters = 3;
  using Gradient = Eigen::Vector3d;
  /// Velocity at x + d less that at x.
  static Vec3 apply(const Gradient& w, const Vec3& d) { return w.cross(d); }
  /// The parameters g with g . w = force . apply(w, d) for every w.
  static Gradient adjoint(const Vec3& force, const Vec3& d) { return d.cross(force); }
  /// |plainness() w| is to be small where nothing else decides.
  static Mat3 plainness() { return Mat3::Identity(); }
};

/// A motion y -> v + A (y - x); the parameters are the columns of A, one below the other.
struct AffineMotion {
  static constexpr int parameters = 9;
  using Gradient = Eigen::Matrix<double, 9, 1>;
  static Vec3 apply(const Gradient& a, const Vec3& d) {
    return d[0] * a.head<3>() + d[1] * a.segment<3>(3) + d[2] * a.tail<3>();
  }
  static Gradient adjoint(const Vec3& force, const Vec3& d) {
    Gradient g;
    for (int column = 0; column < 3; ++column) {
      for (int row = 0; row < 3; ++row) g[row + 3 * column] = force[row] * d[column];
    }
    return g;
  }
  /// Strain counts, spin hardly.
  static Eigen::Matrix<double, 9, 9> plainness() {
    Eigen::Matrix<double, 9, 9> strain;
    for (int column = 0; column < 3; ++column) {
      for (int row = 0; row < 3; ++row) {
        Mat3 e = Mat3::Zero();
        e(row, column) = 1;
        strain.col(row + 3 * column) = ((e + e.transpose()) / 2).reshaped();
      }
    }
    return strain + 1e-4 * Eigen::Matrix<double, 9, 9>::Identity();
  }
};

/// Weights of the rows; all in the units of SurfacePoint.
struct RowWeights {
  double value = 100;   ///< f stays zero: the surface is met.
  double gradient = 1;  ///< The gradient moves with the motion,
  double hessian = 1;   ///< and so does the Hessian.
};

/// Ten rows `matrix` (v, gradient parameters) = `right_side`, each divided by |grad f| and times its weight:
///   f_t + grad f . v = D f
///   d_t grad f + Hess f v = D grad f
///   d_t Hess f + (grad Hess f) v = D Hess f, the six different elements, off-diagonal ones times sqrt 2
/// with the right-hand sides linear in the motion's gradient: StrainResponse. For a rigid motion the field turns as a
/// whole: D f = 0, D grad f = w x grad f, D Hess f = [w]x Hess f - Hess f [w]x.
template <class Motion>
struct MotionRows {
  static constexpr int unknowns = 3 + Motion::parameters;
  Eigen::Matrix<double, 10, unknowns> matrix;
  Eigen::Matrix<double, 10, 1> right_side;
};

MotionRows<RigidMotion> rigid_rows(const SurfacePoint& point, const RowWeights& weights);

/// Exact for every affine motion of the particles around the point.
MotionRows<AffineMotion> affine_rows(const SurfacePoint& point, const KernelMoments& moments,
                                     const RowWeights& weights);

/// Exact for every affine motion that carries the field along as a whole, f(x + v dt + A (x - x0) dt) = f(x): what is
/// to be known where there are no particles. D f = 0, D grad f = -A^T grad f, D Hess f = -(A^T Hess f + Hess f A).
MotionRows<AffineMotion> carried_affine_rows(const SurfacePoint& point, const RowWeights& weights);

/// Either of them for the point x (m) of the field; affine ones by its particles, where it has some.
MotionRows<RigidMotion> field_rows(const LocalField& field, const Vec3& x, const SurfacePoint& point,
                                   const RowWeights& weights, RigidMotion motion);
MotionRows<AffineMotion> field_rows(const LocalField& field, const Vec3& x, const SurfacePoint& point,
                                    const RowWeights& weights, AffineMotion motion);

}  // namespace flowskin::tracking
