// Bodies of particles for the tests of the field and of the velocity methods.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "tracking/particles.h"

namespace flowskin::tracking::test {

/// Uniform numbers that are the same everywhere (std::uniform_real_distribution is not).
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  /// In [-1, 1).
  double symmetric() { return std::ldexp(static_cast<double>(engine_() >> 11U), -52) - 1; }
  Vec3 vector() {
    const double x = symmetric();
    const double y = symmetric();
    const double z = symmetric();
    return {x, y, z};
  }

 private:
  std::mt19937_64 engine_;
};

/// Points of the cubic lattice where `inside` holds, each coordinate jittered by up to `jitter` spacings.
template <class Inside>
std::vector<Vec3> lattice(double spacing, int half_count, double jitter, std::uint64_t seed, const Inside& inside) {
  Random random(seed);
  std::vector<Vec3> points;
  for (int i = -half_count; i <= half_count; ++i) {
    for (int j = -half_count; j <= half_count; ++j) {
      for (int k = -half_count; k <= half_count; ++k) {
        const Vec3 place = spacing * Vec3(i, j, k);
        const Vec3 moved = place + spacing * jitter * random.vector();
        if (inside(place)) points.push_back(moved);
      }
    }
  }
  return points;
}

/// The velocity of every point in a flow.
template <class Flow>
std::vector<Vec3> velocities_of(const std::vector<Vec3>& points, const Flow& flow) {
  std::vector<Vec3> velocities;
  velocities.reserve(points.size());
  for (const Vec3& point : points) velocities.push_back(flow(point));
  return velocities;
}

}  // namespace flowskin::tracking::test
