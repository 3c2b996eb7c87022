#include "tracking/velocity/curvature.h"

#include <cmath>

namespace flowskin::tracking {

Curvatures curvatures(const Vec3& gradient, const Mat3& hessian) {
  const double g2 = gradient.squaredNorm();
  if (!(g2 > 0)) return {};
  const double g = std::sqrt(g2);
  const Vec3 sq = hessian * gradient;
  const double qsq = gradient.dot(sq);
  const double trace = hessian.trace();
  // [FMM13, Eq. 9]
  return {(trace * trace - hessian.squaredNorm()) / (2 * g2) + (sq.squaredNorm() - trace * qsq) / (g2 * g2),
          0.5 * (trace / g - qsq / (g * g2))};
}

CurvatureChange::CurvatureChange(const Vec3& gradient, const Mat3& hessian) {
  const Vec3& q = gradient;
  const Mat3& s = hessian;
  const double g2 = q.squaredNorm();
  if (!(g2 > 0)) return;
  const double g = std::sqrt(g2);
  const double trace = s.trace();
  const Vec3 sq = s * q;
  const double qsq = q.dot(sq);
  // adj(S) q = S S q - tr S S q + (tr(S)^2 - tr(S^2)) / 2 q
  const Vec3 adjoint_q = s * sq - trace * sq + 0.5 * (trace * trace - s.squaredNorm()) * q;
  const double numerator = q.dot(adjoint_q);

  // K = numerator / g^4. The change of q^T adj(S) q with S, from d adj(S) = S dS + dS S - tr(dS) S - tr(S) dS
  // + (tr S tr dS - tr(S dS)) I, is the sum of products of dS and this matrix:
  const Mat3 outer = q * sq.transpose();
  Mat3 by_hessian = outer + outer.transpose() - trace * q * q.transpose() - g2 * s;
  by_hessian.diagonal().array() += g2 * trace - qsq;
  gaussian_by_hessian_ = by_hessian / (g2 * g2);
  gaussian_by_gradient_ = (2 * adjoint_q - 4 * numerator / g2 * q) / (g2 * g2);

  // H = (g^2 tr S - q^T S q) / (2 g^3)
  const double scale = 1 / (2 * g * g2);
  mean_by_hessian_ = -scale * q * q.transpose();
  mean_by_hessian_.diagonal().array() += scale * g2;
  mean_by_gradient_ = scale * (2 * trace * q - 2 * sq - 3 * (trace - qsq / g2) * q);
}

}  // namespace flowskin::tracking
