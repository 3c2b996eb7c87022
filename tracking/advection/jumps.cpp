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
  std::vector<double> errors;
  errors.reserve(particles.size());
  for (const Sighting& particle : particles) {
    const Vec3 expected = usual + duration / 2 * (particle.before + particle.after);
    errors.push_back((particle.displacement - expected).norm());
  }
  const auto is_far = [&](std::size_t i) {
    const double path = std::abs(duration) / 2 * (particles[i].before.norm() + particles[i].after.norm());
    return errors[i] > std::max(shortest, rule.paths * path);
  };
  std::vector<char> result;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (!is_far(i)) continue;
    if (result.empty()) result.resize(particles.size());
    result[i] = 1;
  }
  if (result.empty()) return result;
  // Where many are off, as by a gap in a sequence, being off proves nothing.
  const double limit = rule.usual_errors * quantile(errors, kMost);
  for (std::size_t i = 0; i < particles.size(); ++i) result[i] = result[i] && errors[i] > limit;
  if (std::find(result.begin(), result.end(), 1) == result.end()) result.clear();
  return result;
}

}  // namespace flowskin::tracking
