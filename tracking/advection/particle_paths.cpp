#include "tracking/advection/particle_paths.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "common/number_text.h"
#include "common/quantile.h"
#include "tracking/advection/jumps.h"
#include "tracking/advection/match_ids.h"
#include "tracking/mesh/point_tree.h"

namespace flowskin::tracking {
namespace {

constexpr std::size_t most_samples = 20000;
constexpr double most_share = 0.998;

// One part for each run of equal weights, in the order of the particles.
std::vector<FieldPart> parts_of(const Particles& particles) {
  std::vector<FieldPart> parts;
  for (std::size_t i = 0; i < particles.positions.size(); ++i) {
    const double weight = particles.weights.empty() ? 1 : particles.weights[i];
    if (parts.empty() || parts.back().share != weight) parts.push_back({{}, {}, weight, 0});
    parts.back().positions.push_back(particles.positions[i]);
    if (!particles.velocities.empty()) parts.back().velocities.push_back(particles.velocities[i]);
  }
  return parts;
}

// Where the particles are a time later.
std::vector<Vec3> moved(const Particles& particles, double duration) {
  std::vector<Vec3> positions = particles.positions;
  for (std::size_t i = 0; i < particles.velocities.size(); ++i) positions[i] += duration * particles.velocities[i];
  return positions;
}

// How far nearly all points, of which only some are looked at where there are many, are from the nearest target.
double distance_of_most(const std::vector<Vec3>& points, const std::vector<Vec3>& targets) {
  if (points.empty() || targets.empty()) return 0;
  const PointCloud cloud{targets};
  const PointTree tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(10));
  std::vector<double> distances;
  const std::size_t stride = 1 + points.size() / most_samples;
  for (std::size_t i = 0; i < points.size(); i += stride) {
    int index = 0;
    double squared = 0;
    if (tree.knnSearch(points[i].data(), 1, &index, &squared) == 1) distances.push_back(std::sqrt(squared));
  }
  return quantile(std::move(distances), most_share);
}

}  // namespace

void check_particles(const Particles& particles) {
  const std::size_t count = particles.ids.size();
  const auto fail = [&](const std::string& what) {
    throw std::invalid_argument("particles at time " + number_text(particles.time, 4) + " s: " + what);
  };
  if (!std::isfinite(particles.time)) fail("the time must be finite");
  const auto fits = [count](std::size_t size) { return size == count || size == 0; };
  if (particles.positions.size() != count || !fits(particles.velocities.size()) ||
      !fits(particles.rest_positions.size()) || !fits(particles.weights.size())) {
    fail("ids, positions, velocities and rest positions must have one entry per particle, but have " +
         std::to_string(count) + ", " + std::to_string(particles.positions.size()) + ", " +
         std::to_string(particles.velocities.size()) + ", " + std::to_string(particles.rest_positions.size()) +
         "; weights " + std::to_string(particles.weights.size()));
  }
  for (const std::vector<Vec3>& layer : particles.layers) {
    if (!fits(layer.size()))
      fail("a layer must have one entry per particle, but has " + std::to_string(layer.size()) + " for " +
           std::to_string(count));
    for (std::size_t i = 0; i < layer.size(); ++i)
      if (!layer[i].allFinite())
        fail("the particle with id " + std::to_string(particles.ids[i]) + " has a place in a layer that is not finite");
  }
  const auto finite = [](const std::vector<Vec3>& vectors, std::size_t i) {
    return vectors.empty() || vectors[i].allFinite();
  };
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0 && particles.ids[i] <= particles.ids[i - 1]) {
      fail("ids must ascend, but particle " + std::to_string(i) + " has id " + std::to_string(particles.ids[i]) +
           " after " + std::to_string(particles.ids[i - 1]) + "; sort the particles by id");
    }
    if (!particles.weights.empty() && !(std::isfinite(particles.weights[i]) && particles.weights[i] >= 0)) {
      fail("the particle with id " + std::to_string(particles.ids[i]) + " has a weight that is negative or not finite");
    }
    if (!finite(particles.positions, i) || !finite(particles.velocities, i) || !finite(particles.rest_positions, i)) {
      fail("the particle with id " + std::to_string(particles.ids[i]) + " has a value that is not finite");
    }
  }
}

MetaballField field_of(const Particles& particles, const FieldSettings& settings) {
  FieldWalls walls = field_walls(particles.walls, particles.time, settings);
  if (!particles.weights.empty()) return MetaballField(parts_of(particles), settings, std::move(walls));
  return MetaballField({{particles.positions, particles.velocities}}, settings, std::move(walls));
}

ParticlePaths::ParticlePaths(const Particles& from, const Particles& to, double spacing)
    : begin_(from.time), end_(to.time), walls_(to.walls) {
  const auto unknown = [](const Particles& state) {
    return !state.has_lasting_ids || !state.weights.empty() || (state.velocities.empty() && !state.ids.empty());
  };
  blended_ = unknown(from) || unknown(to);
  if (!blended_) {
    match(from, to, spacing);
    return;
  }
  early_ = parts_of(from);
  late_ = parts_of(to);
  mismatch_ = distance_of_most(moved(from, end_ - begin_), to.positions);
}

void ParticlePaths::match(const Particles& from, const Particles& to, double spacing) {
  const double duration = end_ - begin_;
  paths_.reserve(std::max(from.ids.size(), to.ids.size()));
  const auto goes = [&](std::ptrdiff_t i) {
    const Vec3 &x = from.positions[i], &v = from.velocities[i];
    paths_.push_back({x, v, x + duration * v, v, true});
  };
  const auto comes = [&](std::ptrdiff_t j) {
    const Vec3 &x = to.positions[j], &v = to.velocities[j];
    paths_.push_back({x - duration * v, v, x, v, false});
  };
  std::vector<Sighting> both;
  match_ids(from.ids, to.ids, [&](std::ptrdiff_t i, std::ptrdiff_t j) {
    if (i >= 0 && j >= 0) both.push_back({to.positions[j] - from.positions[i], from.velocities[i], to.velocities[j]});
  });
  const std::vector<char> jump = jumped(both, duration, true, spacing);
  jumps_ = !jump.empty();
  std::size_t k = 0;
  match_ids(from.ids, to.ids, [&](std::ptrdiff_t i, std::ptrdiff_t j) {
    const bool in_both = i >= 0 && j >= 0;
    if (in_both && !(jumps_ && jump[k++])) {
      paths_.push_back({from.positions[i], from.velocities[i], to.positions[j], to.velocities[j], false});
      return;
    }
    if (i >= 0) goes(i);
    if (j >= 0) comes(j);
  });
}

void ParticlePaths::at(double time, std::vector<Vec3>& positions, std::vector<Vec3>& velocities) const {
  positions.clear();
  velocities.clear();
  const double duration = end_ - begin_;
  const double s = time == end_ ? 1 : (time - begin_) / duration;
  if (time == end_) {
    for (const Path& path : paths_) {
      if (path.ends) continue;
      positions.push_back(path.x1);
      velocities.push_back(path.v1);
    }
    return;
  }
  positions.resize(paths_.size());
  velocities.resize(paths_.size());
  const auto count = static_cast<std::ptrdiff_t>(paths_.size());
#pragma omp parallel for schedule(static) if (count > 10000)
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const Path& path = paths_[i];
    if (s == 0) {
      positions[i] = path.x0;
      velocities[i] = path.v0;
      continue;
    }
    const Vec3 chord = path.x1 - path.x0;
    const Vec3 m0 = duration * path.v0, m1 = duration * path.v1;
    positions[i] = path.x0 + s * s * (3 - 2 * s) * chord + s * (s - 1) * (s - 1) * m0 + s * s * (s - 1) * m1;
    velocities[i] = (6 * s * (1 - s) * chord + (s - 1) * (3 * s - 1) * m0 + s * (3 * s - 2) * m1) / duration;
  }
}

MetaballField ParticlePaths::field(double time, const FieldSettings& settings) const {
  FieldWalls walls = field_walls(walls_, time, settings);
  if (!blended_) {
    std::vector<FieldPart> all(1);
    at(time, all.front().positions, all.front().velocities);
    return MetaballField(std::move(all), settings, std::move(walls));
  }
  const double duration = end_ - begin_;
  const double s = time == end_ ? 1 : (time - begin_) / duration;
  const double rate = duration != 0 ? 1 / duration : 0;
  std::vector<FieldPart> parts;
  const auto add = [&parts](const std::vector<FieldPart>& of_state, double elapsed, double share, double share_rate) {
    for (FieldPart part : of_state) {
      for (std::size_t i = 0; i < part.velocities.size(); ++i) part.positions[i] += elapsed * part.velocities[i];
      part.share_rate = part.share * share_rate;
      part.share *= share;
      parts.push_back(std::move(part));
    }
  };
  add(late_, time == end_ ? 0 : time - end_, s, rate);
  add(early_, time - begin_, 1 - s, -rate);
  return MetaballField(std::move(parts), settings, std::move(walls));
}

double ParticlePaths::longest_path() const {
  const double duration = std::abs(end_ - begin_);
  double longest = mismatch_;
  for (const std::vector<FieldPart>* state : {&early_, &late_}) {
    for (const FieldPart& part : *state) {
      for (const Vec3& v : part.velocities) longest = std::max(longest, mismatch_ + duration * v.norm());
    }
  }
  for (const Path& path : paths_) {
    // Control points of the Bezier form of the Hermite curve: their polygon is at least as long as the curve.
    const Vec3 m0 = (end_ - begin_) / 3 * path.v0, m1 = (end_ - begin_) / 3 * path.v1;
    const double middle = (path.x1 - m1 - path.x0 - m0).norm();
    longest = std::max(longest, duration / 3 * (path.v0.norm() + path.v1.norm()) + middle);
  }
  return longest;
}

}  // namespace flowskin::tracking
