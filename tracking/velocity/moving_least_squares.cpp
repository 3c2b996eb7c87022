#include "tracking/velocity/moving_least_squares.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

namespace flowskin::tracking {
namespace {

/// Eigenvalue of the covariance (squared radii) below which the particles count as not spread along its direction.
constexpr double least_spread = 1e-3;

/// Particles that a linear flow always fits.
constexpr int affine_unknowns = 4;
/// Square of the share of the speed below which differences of velocity are rounding.
constexpr double least_spread_of_speed = 1e-20;

/// A particle near the point: lengths in effective radii, from the point.
struct Sample {
  double weight;
  Vec3 offset;
  Vec3 velocity;  // m/s
};

/// Where a thread keeps the neighbours of its point.
std::vector<int>& scratch() {
  thread_local std::vector<int> found;
  return found;
}

std::vector<Sample>& samples_of(const std::vector<int>& found, const ParticleField& field, const Vec3& x) {
  thread_local std::vector<Sample> samples;
  samples.clear();
  const double radius = field.radius();
  for (const int i : found) {
    const Vec3 offset = (field.positions()[i] - x) / radius;
    const double u = std::max(0.0, 1 - offset.squaredNorm());
    samples.push_back({u * u * u, offset, field.velocities().empty() ? Vec3(Vec3::Zero()) : field.velocities()[i]});
  }
  return samples;
}

/// Inverse of a covariance in the directions in which it is larger than least_spread, zero in the others, smoothly in
/// between.
Mat3 damped_inverse(const Mat3& covariance) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(covariance);
  Vec3 inverse;
  for (int k = 0; k < 3; ++k) {
    const double ratio = std::max(0.0, solver.eigenvalues()[k] / least_spread);
    const double power = std::pow(ratio, 15);
    inverse[k] = power / (1 + power * ratio) / least_spread;
  }
  return solver.eigenvectors() * inverse.asDiagonal() * solver.eigenvectors().transpose();
}

/// The flow that fits these particles best.
LocalFlow flow_of(const std::vector<int>& found, const ParticleField& field, const Vec3& x) {
  LocalFlow flow;
  std::vector<Sample>& samples = samples_of(found, field, x);
  flow.neighbors = static_cast<int>(samples.size());

  double weights = 0;
  Vec3 center = Vec3::Zero();
  Vec3 mean = Vec3::Zero();
  for (const Sample& sample : samples) {
    weights += sample.weight;
    center += sample.weight * sample.offset;
    mean += sample.weight * sample.velocity;
  }
  if (!(weights > 0)) return flow;
  flow.defined = true;
  center /= weights;
  mean /= weights;

  Mat3 covariance = Mat3::Zero();
  Mat3 products = Mat3::Zero();
  for (Sample& sample : samples) {
    sample.weight /= weights;
    sample.offset -= center;
    covariance += sample.weight * sample.offset * sample.offset.transpose();
    products += sample.weight * (sample.velocity - mean) * sample.offset.transpose();
  }
  const Mat3 inverse = damped_inverse(covariance);
  // Across the directions in which the particles spread, the flow is taken to turn along with them: an antisymmetric
  // gradient, as far as it is free.
  const Mat3 spanned = covariance * inverse;  // the projection on those directions
  const Mat3 known = products * inverse;      // per radius
  const Mat3 gradient = known - spanned * known.transpose() * (Mat3::Identity() - spanned);
  flow.velocity = mean - gradient * center;
  flow.gradient = gradient / field.radius();
  flow.center = center * field.radius();

  double rest = 0, spread = 0, all = 0, weights2 = 0;
  for (const Sample& sample : samples) {
    rest += sample.weight * (sample.velocity - mean - gradient * sample.offset).squaredNorm();
    weights2 += sample.weight * sample.weight;
    spread += sample.weight * (sample.velocity - mean).squaredNorm();
    all += sample.weight * sample.velocity.squaredNorm();
  }
  // Of n samples with independent errors, n - 4 are left to show them.
  const double freedom = 1.0 / std::max(1, flow.neighbors - affine_unknowns) * flow.neighbors;
  flow.gradient_error2 = freedom * rest * weights2 * inverse.trace() / (field.radius() * field.radius());
  // Velocities that differ by rounding alone have no spread.
  if (spread > least_spread_of_speed * all) flow.misfit = std::min(1.0, std::sqrt(rest / spread));
  return flow;
}

}  // namespace

LocalFlow local_flow(const ParticleField& field, const Vec3& x) {
  field.neighbors(x, field.radius(), scratch());
  return flow_of(scratch(), field, x);
}

LocalFlow local_flow(const LocalParticles& field, const Vec3& x) {
  field.neighbors(x, scratch());
  return flow_of(scratch(), field.all(), x);
}

}  // namespace flowskin::tracking
