#include "tracking/velocity/surface_point.h"

#include <cmath>

namespace flowskin::tracking {
namespace {

/// Below this share of the scale a gradient is rounding: the field does not say where its surface goes.
constexpr double least_slope = 1e-9;
/// Near critical points of f the normal velocity f_t / |grad f| is without bound; slopes of this size damp it.
constexpr double damping_slope = 1e-6;

MotionJet without_units(const MotionJet& jet, const FieldScale& scale) {
  const double per_weight = 1 / scale.value;
  const double first = per_weight * scale.length;
  const double second = first * scale.length;
  const double third = second * scale.length;
  MotionJet scaled;
  scaled.moving_value = jet.moving_value * per_weight;
  scaled.gradient = jet.gradient * first;
  scaled.hessian = jet.hessian * second;
  for (int k = 0; k < 3; ++k) scaled.third[k] = jet.third[k] * third;
  scaled.value_rate = jet.value_rate * per_weight;
  scaled.gradient_rate = jet.gradient_rate * first;
  scaled.hessian_rate = jet.hessian_rate * second;
  scaled.neighbors = jet.neighbors;
  return scaled;
}

/// [T. Duff et al., Building an orthonormal basis, revisited, JCGT 6, 2017]
Mat32 tangents_of(const Vec3& n) {
  const double sign = std::copysign(1.0, n.z());
  const double a = -1 / (sign + n.z());
  const double b = n.x() * n.y() * a;
  Mat32 tangents;
  tangents.col(0) << 1 + sign * n.x() * n.x() * a, sign * b, -sign * n.x();
  tangents.col(1) << b, sign + n.y() * n.y() * a, -n.y();
  return tangents;
}

}  // namespace

SurfacePoint::SurfacePoint(const MotionJet& jet_with_units, const FieldScale& scale)
    : jet(without_units(jet_with_units, scale)) {
  slope = jet.gradient.norm();
  defined = slope > least_slope;
  if (!defined) return;
  normal = jet.gradient / slope;
  tangents = tangents_of(normal);
  normal_velocity = -jet.value_rate * slope / (slope * slope + damping_slope * damping_slope) * normal;
}

}  // namespace flowskin::tracking
