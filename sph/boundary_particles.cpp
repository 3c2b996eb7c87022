#include "sph/boundary_particles.h"

#include <algorithm>

#include "sph/hilbert_order.h"

namespace flowskin::sph {

namespace {

// Puts values[first], values[first + 1], ... into the order given.
template <typename T>
void rearrange(std::vector<T>& values, std::size_t first, const std::vector<std::uint32_t>& order) {
  std::vector<T> sorted;
  sorted.reserve(order.size());
  for (const std::uint32_t k : order) sorted.push_back(values[first + k]);
  std::copy(sorted.begin(), sorted.end(), values.begin() + static_cast<std::ptrdiff_t>(first));
}

std::vector<Vec3> in_curve_order(const std::vector<Vec3>& points, double spacing) {
  if (points.empty()) return {};
  std::vector<Eigen::Vector3f> places;
  for (const Vec3& p : points) places.push_back((p - points[0]).cast<float>());
  HilbertOrder curve;
  curve.compute(places, static_cast<float>(spacing));
  std::vector<Vec3> sorted = points;
  rearrange(sorted, 0, curve.order());
  return sorted;
}

}  // namespace

BoundaryParticles::BoundaryParticles(const std::vector<Boundary>& boundaries, const SolverSettings& settings,
                                     const WallKernel& wall, const PeriodicBox& periodic)
    : sample_spacing_(wall.sample_spacing), support_(wall.support), periodic_(periodic) {
  const auto append_volumes = [&](std::size_t first) {
    const std::vector<Vec3> group(positions_.begin() + static_cast<std::ptrdiff_t>(first), positions_.end());
    const std::vector<double> volumes = boundary_volumes(group, settings.kernel, support_, periodic);
    volumes_.insert(volumes_.end(), volumes.begin(), volumes.end());
  };
  std::vector<TriangleMesh> resting;
  for (const Boundary& boundary : boundaries) {
    greatest_speed_ = std::max(greatest_speed_, boundary.surface_velocity.norm());
    if (boundary.motion.moves()) continue;
    resting.push_back(periodic.clip(boundary.mesh));
    append_samples(sample_surface(resting.back(), sample_spacing_, periodic), boundary);
  }
  append_volumes(0);
  if (!resting.empty()) guard_ = WallGuard(resting, 2 * settings.spacing, periodic);
  for (const Boundary& boundary : boundaries) {
    if (!boundary.motion.moves()) continue;
    // Sampled at rest; a wall's volumes are its own, since it may leave the others.
    const TriangleMesh mesh = periodic.clip(boundary.mesh);
    const std::vector<Vec3> samples = in_curve_order(sample_surface(mesh, sample_spacing_, periodic), sample_spacing_);
    const std::size_t first = positions_.size();
    append_samples(samples, boundary);
    append_volumes(first);
    movers_.emplace_back(boundary.motion, boundary.surface_velocity, mesh, samples, first, 2 * settings.spacing,
                         periodic);
    greatest_speed_ = std::max(greatest_speed_, movers_.back().greatest_speed() + boundary.surface_velocity.norm());
  }
  move_to(0);
}

void BoundaryParticles::append_samples(const std::vector<Vec3>& samples, const Boundary& boundary) {
  positions_.insert(positions_.end(), samples.begin(), samples.end());
  slips_.resize(positions_.size(), boundary.slip);
  surface_velocities_.resize(positions_.size(), boundary.surface_velocity);
}

void BoundaryParticles::place_at_origin(const Vec3& origin) {
  origin_ = origin;
  // Moving walls are in order already.
  const std::size_t resting = movers_.empty() ? positions_.size() : movers_.front().first();
  std::vector<Eigen::Vector3f> points(resting);
  for (std::size_t b = 0; b < resting; ++b) points[b] = (positions_[b] - origin).cast<float>();
  HilbertOrder curve;
  curve.compute(points, static_cast<float>(sample_spacing_));
  rearrange(positions_, 0, curve.order());
  rearrange(volumes_, 0, curve.order());
  rearrange(slips_, 0, curve.order());
  rearrange(surface_velocities_, 0, curve.order());

  packs_.resize(positions_.size());
  const double unit = support_ * support_ * support_;
  for (std::size_t k = 0; k < packs_.size(); ++k) {
    const Eigen::Vector3f x = (positions_[k] - origin).cast<float>(), v = surface_velocities_[k].cast<float>();
    packs_[k] = {x.x(), x.y(), x.z(), static_cast<float>(volumes_[k] / unit), static_cast<float>(1 - slips_[k]),
                 v.x(), v.y(), v.z()};
  }
  volumes_ = {};
  slips_ = {};
  surface_velocities_ = {};
  move_to(0);
  clusters_.assign(packs_, static_cast<float>(6 * sample_spacing_));
}

void BoundaryParticles::move_to(double time) {
  time_ = time;
  last_shift_ = 0;
  for (MovingWall& wall : movers_) {
    wall.move_to(time);
    last_shift_ = std::max(last_shift_, wall.last_shift());
    for (std::size_t k = 0; k < wall.count(); ++k) {
      Vec3& position = positions_[wall.first() + k];
      position = periodic_.wrap(wall.position(k));
      if (packs_.empty()) continue;
      WallPack& pack = packs_[wall.first() + k];
      const Eigen::Vector3f x = (position - origin_).cast<float>(), v = wall.velocity(k).cast<float>();
      pack.x = x.x(), pack.y = x.y(), pack.z = x.z();
      pack.vx = v.x(), pack.vy = v.y(), pack.vz = v.z();
    }
  }
}

double BoundaryParticles::shift_since_build() const {
  double farthest = 0;
  for (const MovingWall& wall : movers_) farthest = std::max(farthest, wall.shift_since_build());
  return farthest;
}

void BoundaryParticles::mark_build(std::size_t fluid_clusters) {
  build_time_ = time_;
  triangles_.resize(fluid_clusters);
  for (auto& triangles : triangles_) triangles.clear();
  for (MovingWall& wall : movers_) wall.mark_build(fluid_clusters);
  if (!movers_.empty()) clusters_.assign(packs_, static_cast<float>(6 * sample_spacing_));
}

void BoundaryParticles::collect_triangles(std::size_t cluster, const Vec3& low, const Vec3& high, double margin) {
  guard_.query(low - Vec3::Constant(margin), high + Vec3::Constant(margin), triangles_[cluster]);
  for (MovingWall& wall : movers_) wall.collect_triangles(cluster, low, high, margin);
}

BoundaryParticles::Hold BoundaryParticles::hold_near(const Vec3& from, std::size_t cluster, Vec3& target,
                                                     Vec3& velocity) const {
  if (!movers_.empty()) return hold_between(from, cluster, target, velocity);
  if (triangles_[cluster].empty()) return {};
  const WallGuard::Crossing crossing = guard_.check(from, target, triangles_[cluster]);
  if (!crossing.crossed) return {};
  velocity -= std::min(0.0, velocity.dot(crossing.normal)) * crossing.normal;
  target = from;
  return {true, false};
}

// Wall after wall corrects the path until none objects. A wall that moves may carry a particle into one that rests:
// there it may slide along.
BoundaryParticles::Hold BoundaryParticles::hold_between(const Vec3& from, std::size_t cluster, Vec3& target,
                                                        Vec3& velocity) const {
  constexpr int rounds = 4;
  Hold result;
  for (int round = 0; round < rounds; ++round) {
    bool corrected = false;
    const WallGuard::Crossing crossing = guard_.check(from, target, triangles_[cluster]);
    if (crossing.crossed) {
      corrected = true;
      velocity -= std::min(0.0, velocity.dot(crossing.normal)) * crossing.normal;
      const Vec3 way = target - from;
      target = round == 0 ? from : Vec3(from + way - std::min(0.0, way.dot(crossing.normal)) * crossing.normal);
    }
    for (const MovingWall& wall : movers_) corrected = wall.hold(from, cluster, target, velocity) || corrected;
    if (!corrected) return result;
    result.held = true;
  }
  // No way out between walls that close in. Those that rest hold.
  if (guard_.check(from, target, triangles_[cluster]).crossed) target = from;
  Vec3 end = target, unused = velocity;
  for (const MovingWall& wall : movers_) {
    result.squeezed_through = wall.hold(from, cluster, end, unused) || result.squeezed_through;
  }
  return result;
}

std::size_t BoundaryParticles::memory_bytes() const {
  std::size_t bytes = positions_.capacity() * sizeof(Vec3) + packs_.capacity() * sizeof(WallPack) +
                      clusters_.memory_bytes() + guard_.memory_bytes() +
                      triangles_.capacity() * sizeof(decltype(triangles_)::value_type);
  for (const auto& triangles : triangles_) bytes += triangles.capacity() * sizeof(std::uint32_t);
  for (const MovingWall& wall : movers_) bytes += wall.memory_bytes();
  return bytes;
}

}  // namespace flowskin::sph
