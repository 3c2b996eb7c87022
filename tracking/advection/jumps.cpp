#include "tracking/advection/jumps.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "common/quantile.h"

namespace flowskin::tracking {
namespace {

constexpr double kMost = 0.9;  // share of the particles that are usual

Vec3 median_displacement(const std::vector<Sighting>& particles) {
  Vec3 median;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    values.reserve(particles.size());
    for (const Sighting& particle : particles) values.push_back(particle.displacement[axis]);
    median[axis] = quantile(std::move(values), 0.5);
  }
  return median;
}

}  // namespace

std::vector<char> jumped(const std::vector<Sighting>& particles, double duration, bool has_velocities, double spacing,
                         const JumpRule& rule) {
  const double shortest = spacing * (has_velocities ? rule.shortest : rule.shortest_without_velocities);
  const Vec3 usual = has_velocities ? Vec3(Vec3::Zero()) : median_displacement(particles);
  const auto error = [&](const Sighting& particle) {
    return (particle.displacement - usual - duration / 2 * (particle.before + particle.after)).norm();
  };
  const auto is_far = [&](const Sighting& particle) {
    const double path = std::abs(duration) / 2 * (particle.before.norm() + particle.after.norm());
    return error(particle) > std::max(shortest, rule.paths * path);
  };
  if (std::none_of(particles.begin(), particles.end(), is_far)) return {};
  // Where many are off, as by a gap in a sequence, being off proves nothing.
  std::vector<double> errors;
  errors.reserve(particles.size());
  for (const Sighting& particle : particles) errors.push_back(error(particle));
  const double limit = rule.usual_errors * quantile(errors, kMost);
  std::vector<char> result(particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) result[i] = errors[i] > limit && is_far(particles[i]);
  if (std::find(result.begin(), result.end(), 1) == result.end()) result.clear();
  return result;
}

}  // namespace flowskin::tracking
