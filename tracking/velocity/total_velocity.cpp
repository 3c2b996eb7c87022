#include "tracking/velocity/total_velocity.h"

#include <algorithm>
#include <cmath>

#include "tracking/velocity/methods.h"
#include "tracking/velocity/pointwise_velocity.h"

namespace flowskin::tracking {
namespace {

/// Curvature times radius below which a direction is flat to rounding.
constexpr double least_damping = 1e-9;
/// Of the method `total`, chosen by measurement, see docs/velocity_methods.md.
constexpr double total_damping = 0.7;

/// M^3 (M^4 + d^4 I)^-1 b for symmetric M: the inverse of M in the directions in which it is larger than d, zero in the
/// others, smoothly in between. By one Jacobi rotation, as powers of M would lose the smaller eigenvalue.
Vec2 damped_solution(const Mat2& m, const Vec2& b, double d) {
  double tangent = 0;  // of the angle to the eigenvectors
  if (m(0, 1) != 0) {
    const double difference = 0.5 * (m(1, 1) - m(0, 0));
    tangent = m(0, 1) / (difference + std::copysign(std::hypot(difference, m(0, 1)), difference));
  }
  const double cosine = 1 / std::sqrt(1 + tangent * tangent);
  const Vec2 first(cosine, -tangent * cosine);
  const Vec2 second(tangent * cosine, cosine);
  const double d4 = d * d * d * d;
  const auto inverse = [d4](double value) {
    const double cube = value * value * value;
    return cube / (cube * value + d4);
  };
  return inverse(m(0, 0) - tangent * m(0, 1)) * first.dot(b) * first +
         inverse(m(1, 1) + tangent * m(0, 1)) * second.dot(b) * second;
}

/// Share of the change of the Hessian that a translation by v does not explain: 0 for a translation, at most about 1.
double unexplained_by_translation(const SurfacePoint& point, const Vec3& v) {
  const Mat3 carried = point.hessian_along(v);
  const double all = point.jet.hessian_rate.squaredNorm() + carried.squaredNorm();
  return all > 0 ? std::min(1.0, std::sqrt((point.jet.hessian_rate + carried).squaredNorm() / all)) : 0;
}

class TotalVelocity final : public PointwiseVelocity {
 public:
  Vec3 velocity(const SurfacePoint& point) const override {
    return point.normal_velocity + point.tangents * total_tangential_velocity(point, total_damping);
  }
};

}  // namespace

Vec2 total_tangential_velocity(const SurfacePoint& point, double damping) {
  const Mat32 hessian_tangents = point.jet.hessian * point.tangents;
  const Mat2 m = point.tangents.transpose() * hessian_tangents / point.slope;
  const Vec2 b =
      -(point.tangents.transpose() * point.jet.gradient_rate + hessian_tangents.transpose() * point.normal_velocity) /
      point.slope;
  const Vec2 undamped = damped_solution(m, b, least_damping);
  const double unexplained = unexplained_by_translation(point, point.normal_velocity + point.tangents * undamped);
  return damped_solution(m, b, damping * unexplained + least_damping);
}

VelocityMethodInfo total_velocity_info() {
  return {"total", "Keeps the direction of the normal: exact for translation, does not see rotation.",
          []() -> std::unique_ptr<VelocityMethod> { return std::make_unique<TotalVelocity>(); }};
}

}  // namespace flowskin::tracking
