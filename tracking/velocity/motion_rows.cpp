#include "tracking/velocity/motion_rows.h"

#include <numbers>

namespace flowskin::tracking {
namespace {

using HessianRows = Eigen::Matrix<double, 6, 1>;

// A symmetric matrix as a vector of the same norm.
HessianRows flat(const Mat3& s) {
  constexpr double root = std::numbers::sqrt2;
  HessianRows rows;
  rows << s(0, 0), s(1, 1), s(2, 2), root * s(0, 1), root * s(0, 2), root * s(1, 2);
  return rows;
}

// The rows of all motions, but for the columns of their gradients.
template <class Rows>
void set_velocity_rows(const SurfacePoint& point, const RowWeights& weights, Rows& rows) {
  const MotionJet& jet = point.jet;
  const double value = weights.value / point.slope;
  const double first = weights.gradient / point.slope;
  const double second = weights.hessian / point.slope;
  rows.matrix.template block<1, 3>(0, 0) = value * jet.gradient.transpose();
  rows.matrix.template block<3, 3>(1, 0) = first * jet.hessian;
  for (int axis = 0; axis < 3; ++axis) {
    rows.matrix.template block<6, 1>(4, axis) = second * flat(jet.third[axis]);
  }
  rows.right_side << -value * jet.value_rate, -first * jet.gradient_rate, -second * flat(jet.hessian_rate);
}

template <class Rows>
void set_gradient_column(const SurfacePoint& point, const RowWeights& weights, int parameter,
                         const StrainResponse& response, Rows& rows) {
  auto column = rows.matrix.col(3 + parameter);
  column[0] = -weights.value / point.slope * response.value;
  column.template segment<3>(1) = -weights.gradient / point.slope * response.gradient;
  column.template segment<6>(4) = -weights.hessian / point.slope * flat(response.hessian);
}

}  // namespace

MotionRows<RigidMotion> rigid_rows(const SurfacePoint& point, const RowWeights& weights) {
  MotionRows<RigidMotion> rows;
  set_velocity_rows(point, weights, rows);
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 w = Vec3::Unit(axis);
    Mat3 turned;
    for (int column = 0; column < 3; ++column) turned.col(column) = w.cross(point.jet.hessian.col(column));
    set_gradient_column(point, weights, axis, {0, w.cross(point.jet.gradient), turned + turned.transpose()}, rows);
  }
  return rows;
}

MotionRows<AffineMotion> affine_rows(const SurfacePoint& point, const KernelMoments& moments,
                                     const RowWeights& weights) {
  MotionRows<AffineMotion> rows;
  set_velocity_rows(point, weights, rows);
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) {
      set_gradient_column(point, weights, row + 3 * column, moments.response(row, column), rows);
    }
  }
  return rows;
}

MotionRows<AffineMotion> carried_affine_rows(const SurfacePoint& point, const RowWeights& weights) {
  MotionRows<AffineMotion> rows;
  set_velocity_rows(point, weights, rows);
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) {
      Mat3 a = Mat3::Zero();
      a(row, column) = 1;
      const Mat3 half = point.jet.hessian * a;
      set_gradient_column(point, weights, row + 3 * column,
                          {0, -a.transpose() * point.jet.gradient, -(half + half.transpose())}, rows);
    }
  }
  return rows;
}

MotionRows<RigidMotion> field_rows(const LocalField& /*field*/, const Vec3& /*x*/, const SurfacePoint& point,
                                   const RowWeights& weights, RigidMotion /*motion*/) {
  return rigid_rows(point, weights);
}

MotionRows<AffineMotion> field_rows(const LocalField& field, const Vec3& x, const SurfacePoint& point,
                                    const RowWeights& weights, AffineMotion /*motion*/) {
  const LocalParticles* particles = field.particles();
  return particles ? affine_rows(point, particles->moments(x), weights) : carried_affine_rows(point, weights);
}

}  // namespace flowskin::tracking
