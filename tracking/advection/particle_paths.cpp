#include "tracking/advection/particle_paths.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace flowskin::tracking {

void check_particles(const Particles& particles) {
  const std::size_t count = particles.ids.size();
  const auto fail = [&](const std::string& what) {
    throw std::invalid_argument("particles at time " + std::to_string(particles.time) + " s: " + what);
  };
  if (!std::isfinite(particles.time)) fail("the time must be finite");
  if (particles.positions.size() != count || particles.velocities.size() != count ||
      particles.rest_positions.size() != count) {
    fail("ids, positions, velocities and rest positions must have one entry a particle, but have " +
         std::to_string(count) + ", " + std::to_string(particles.positions.size()) + ", " +
         std::to_string(particles.velocities.size()) + ", " + std::to_string(particles.rest_positions.size()));
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0 && particles.ids[i] <= particles.ids[i - 1]) {
      fail("ids must ascend, but particle " + std::to_string(i) + " has id " + std::to_string(particles.ids[i]) +
           " after " + std::to_string(particles.ids[i - 1]) + "; sort the particles by id");
    }
    if (!particles.positions[i].allFinite() || !particles.velocities[i].allFinite() ||
        !particles.rest_positions[i].allFinite()) {
      fail("the particle with id " + std::to_string(particles.ids[i]) + " has a value that is not finite");
    }
  }
}

ParticlePaths::ParticlePaths(const Particles& from, const Particles& to) : begin_(from.time), end_(to.time) {
  const double duration = end_ - begin_;
  const std::size_t old_count = from.ids.size(), new_count = to.ids.size();
  paths_.reserve(std::max(old_count, new_count));
  std::size_t i = 0, j = 0;
  while (i < old_count || j < new_count) {
    if (j == new_count || (i < old_count && from.ids[i] < to.ids[j])) {
      const Vec3 &x = from.positions[i], &v = from.velocities[i++];
      paths_.push_back({x, v, x + duration * v, v, true});
    } else if (i == old_count || to.ids[j] < from.ids[i]) {
      const Vec3 &x = to.positions[j], &v = to.velocities[j++];
      paths_.push_back({x - duration * v, v, x, v, false});
    } else {
      paths_.push_back({from.positions[i], from.velocities[i], to.positions[j], to.velocities[j], false});
      ++i, ++j;
    }
  }
}

void ParticlePaths::at(double time, std::vector<Vec3>& positions, std::vector<Vec3>& velocities) const {
  positions.clear();
  velocities.clear();
  const double duration = end_ - begin_;
  const bool at_end = time == end_;
  const double s = at_end ? 1 : (time - begin_) / duration;
  for (const Path& path : paths_) {
    if (at_end) {
      if (path.ends) continue;
      positions.push_back(path.x1);
      velocities.push_back(path.v1);
    } else if (s == 0) {
      positions.push_back(path.x0);
      velocities.push_back(path.v0);
    } else {
      const Vec3 chord = path.x1 - path.x0;
      const Vec3 m0 = duration * path.v0, m1 = duration * path.v1;
      positions.push_back(path.x0 + s * s * (3 - 2 * s) * chord + s * (s - 1) * (s - 1) * m0 + s * s * (s - 1) * m1);
      velocities.push_back((6 * s * (1 - s) * chord + (s - 1) * (3 * s - 1) * m0 + s * (3 * s - 2) * m1) / duration);
    }
  }
}

MetaballField ParticlePaths::field(double time, const FieldSettings& settings) const {
  std::vector<Vec3> positions, velocities;
  at(time, positions, velocities);
  return MetaballField(std::move(positions), std::move(velocities), settings);
}

double ParticlePaths::longest_path() const {
  const double duration = std::abs(end_ - begin_);
  double longest = 0;
  for (const Path& path : paths_) {
    // Control points of the Bezier form of the Hermite curve: their polygon is at least as long as the curve.
    const Vec3 m0 = (end_ - begin_) / 3 * path.v0, m1 = (end_ - begin_) / 3 * path.v1;
    const double middle = (path.x1 - m1 - path.x0 - m0).norm();
    longest = std::max(longest, duration / 3 * (path.v0.norm() + path.v1.norm()) + middle);
  }
  return longest;
}

}  // namespace flowskin::tracking
