#include "tracking/velocity/confidence.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "tracking/field/neighborhoods.h"
#include "tracking/velocity/motion_rows.h"

namespace flowskin::tracking {
namespace {

constexpr RowWeights confidence_weights{1, 1, 0.3};
constexpr double half_confidence = 0.1;  // the information s0 that counts as half known; see docs/velocity_methods.md
constexpr double least_spin = 1e-10;  // a spin that moves the rows less than this is no excuse, relative to the others

}  // namespace

Confidence field_confidence(const SurfacePoint& point) {
  Confidence confidence;
  if (!point.defined) return confidence;
  const auto rows = rigid_rows(point, confidence_weights);
  const Eigen::Matrix<double, 9, 2> along = rows.matrix.bottomLeftCorner<9, 3>() * point.tangents;
  const Eigen::Matrix<double, 9, 3> spin = rows.matrix.bottomRightCorner<9, 3>();
  Mat3 spin_normal = spin.transpose() * spin;
  spin_normal.diagonal().array() += least_spin * spin_normal.trace();
  const Eigen::Matrix<double, 3, 2> shared = spin.transpose() * along;
  const Mat2 information = along.transpose() * along - shared.transpose() * spin_normal.ldlt().solve(shared);
  const Eigen::SelfAdjointEigenSolver<Mat2> solver(information);
  if (solver.info() != Eigen::Success || !solver.eigenvalues().allFinite()) return confidence;
  const auto of = [](double s) { return s > 0 ? s / (s + half_confidence) : 0.0; };
  confidence.weak = of(solver.eigenvalues()[0]);
  confidence.strong = of(solver.eigenvalues()[1]);
  confidence.weak_direction = point.tangents * solver.eigenvectors().col(0);
  return confidence;
}

std::vector<Confidence> field_confidence(const ImplicitField& field, const std::vector<Vec3>& positions) {
  std::vector<Confidence> confidences(positions.size());
  Neighborhoods(field, positions).for_each([&](int v, const LocalField& local) {
    confidences[v] = field_confidence(SurfacePoint(local.motion_jet(positions[v]), field.scale()));
  });
  return confidences;
}

}  // namespace flowskin::tracking
