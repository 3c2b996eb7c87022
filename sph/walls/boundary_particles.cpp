#include "sph/walls/boundary_particles.h"

#include <algorithm>
#include <cmath>

#include "sph/neighbors/hilbert_order.h"
#include "sph/walls/wall_reach.h"

namespace flowskin::sph {

namespace {

// Volume V_b over the area of a boundary particle in a plane: factor / (area sum W) over the square lattice.
double area_to_volume(const SolverSettings& settings, const WallKernel& wall) {
  const int reach = static_cast<int>(std::ceil(wall.support / wall.sample_spacing));
  double sum = 0;
  for (int i = -reach; i <= reach; ++i) {
    for (int j = -reach; j <= reach; ++j) {
      sum += kernel_value(settings.kernel, wall.sample_spacing * std::hypot(i, j), wall.support);
    }
  }
  return wall.volume_factor / (wall.sample_spacing * wall.sample_spacing * sum);
}

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

// How far the lists of pairs of fluid particles reach, at most.
double list_reach(const SolverSettings& settings) {
  constexpr double tension_reach = 3.0, widest_automatic_skin = 0.5;
  const double support = std::max(settings.support_radius, settings.surface_tension > 0 ? tension_reach : 0.0);
  return (support + std::max(settings.skin, widest_automatic_skin)) * settings.spacing;
}

}  // namespace

BoundaryParticles::BoundaryParticles(const std::vector<Boundary>& boundaries, const SolverSettings& settings,
                                     const WallKernel& wall, const PeriodicBox& periodic)
    : sample_spacing_(wall.sample_spacing), support_(wall.support), gap_width_(settings.spacing), periodic_(periodic) {
  const auto append_volumes = [&](std::size_t first) {
    const std::vector<Vec3> group(positions_.begin() + static_cast<std::ptrdiff_t>(first), positions_.end());
    for (const double volume : boundary_volumes(group, settings.kernel, support_, periodic)) {
      volumes_.push_back(wall.volume_factor * volume);
    }
  };
  const Box reach = wall_reach(settings);
  WallCount count(settings.spacing, sample_spacing_);
  for (std::size_t b = 0; b < boundaries.size(); ++b) {
    const bool moves = boundaries[b].motion.moves();
    count.add(periodic.clip(boundaries[b].mesh), moves ? everywhere() : reach, "boundary " + std::to_string(b + 1));
  }
  std::vector<TriangleMesh> resting;
  for (const Boundary& boundary : boundaries) {
    greatest_speed_ = std::max(greatest_speed_, boundary.surface_velocity.norm());
    if (boundary.motion.moves()) continue;
    resting.push_back(periodic.clip(boundary.mesh));
    append_samples(sample_surface(resting.back(), sample_spacing_, periodic, reach), boundary);
  }
  append_volumes(0);
  if (!resting.empty()) {
    guard_ = WallGuard(resting, 2 * settings.spacing, periodic, reach);
    thin_ = ThinWalls(resting, guard_, settings.spacing, list_reach(settings), periodic, reach);
    guard_.find_gaps(positions_, sample_spacing_, settings.spacing, periodic);
  }
  for (const Boundary& boundary : boundaries) {
    if (!boundary.motion.moves()) continue;
    // Sampled at rest; a wall's volumes are its own, since it may leave the others.
    const TriangleMesh mesh = periodic.clip(boundary.mesh);
    const std::vector<Vec3> samples = in_curve_order(sample_surface(mesh, sample_spacing_, periodic), sample_spacing_);
    const std::size_t first = positions_.size();
    append_samples(samples, boundary);
    append_volumes(first);
    movers_.emplace_back(boundary.motion, boundary.surface_velocity, mesh, samples, first, sample_spacing_,
                         settings.spacing, list_reach(settings), periodic);
    greatest_speed_ = std::max(greatest_speed_, movers_.back().greatest_speed() + boundary.surface_velocity.norm());
  }
  scale_adhesions(settings, wall);
  move_to(0);
}

void BoundaryParticles::scale_adhesions(const SolverSettings& settings, const WallKernel& wall) {
  if (std::none_of(adhesions_.begin(), adhesions_.end(), [](float a) { return a > 0; })) {
    adhesions_ = {};
    return;
  }
  const double thickness = area_to_volume(settings, wall);
  for (std::size_t b = 0; b < adhesions_.size(); ++b) adhesions_[b] *= static_cast<float>(volumes_[b] / thickness);
}

void BoundaryParticles::append_samples(const std::vector<Vec3>& samples, const Boundary& boundary) {
  positions_.insert(positions_.end(), samples.begin(), samples.end());
  slips_.resize(positions_.size(), boundary.slip);
  adhesions_.resize(positions_.size(), static_cast<float>(boundary.adhesion));
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
  if (!adhesions_.empty()) rearrange(adhesions_, 0, curve.order());
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
  near_gap_.assign(fluid_clusters, NearGap::none);
  for (MovingWall& wall : movers_) wall.mark_build(fluid_clusters);
  if (!movers_.empty()) clusters_.assign(packs_, static_cast<float>(6 * sample_spacing_));
}

void BoundaryParticles::collect_triangles(std::size_t cluster, const Vec3& low, const Vec3& high, double margin) {
  bool near_gap = guard_.collect(low, high, margin, triangles_[cluster]);
  for (MovingWall& wall : movers_) near_gap = wall.collect_triangles(cluster, low, high, margin) || near_gap;
  const bool near_others = !movers_.empty() && collect_between(cluster, low, high, margin);
  near_gap_[cluster] = near_others ? NearGap::between : near_gap ? NearGap::within : NearGap::none;
}

bool BoundaryParticles::collect_between(std::size_t cluster, const Vec3& low, const Vec3& high, double margin) {
  const Vec3 reach = Vec3::Constant(margin + gap_width_);
  std::vector<std::vector<std::uint32_t>> found(movers_.size());
  std::size_t near = 0;
  for (std::size_t w = 0; w < movers_.size(); ++w) {
    movers_[w].find_triangles(low - reach, high + reach, found[w]);
    near += !found[w].empty();
  }
  if (near == 0) return false;
  std::vector<std::uint32_t> resting;
  guard_.query_touching(low - reach, high + reach, resting);
  if (near + !resting.empty() < 2) return false;
  triangles_[cluster] = resting;
  for (std::size_t w = 0; w < movers_.size(); ++w) movers_[w].mark_gap(cluster, found[w]);
  return true;
}

Hold BoundaryParticles::hold_near(const Vec3& from, std::size_t cluster, Vec3& target, Vec3& velocity) const {
  if (!movers_.empty()) return hold_between(from, cluster, target, velocity);
  if (triangles_[cluster].empty()) return {};
  const bool near_gap = near_gap_[cluster] != NearGap::none;
  const WallGuard::Crossing crossing = guard_.check(from, target, triangles_[cluster], near_gap);
  if (!crossing.crossed) return {.kept_out = near_gap && keep_out(from, cluster, target, velocity)};
  velocity -= std::min(0.0, velocity.dot(crossing.normal)) * crossing.normal;
  target = from;
  return {.held = true};
}

bool BoundaryParticles::keep_out(const Vec3& from, std::size_t cluster, Vec3& target, Vec3& velocity) const {
  Vec3 normal;
  if (!guard_.keep_out(from, triangles_[cluster], target, normal)) return false;
  velocity -= std::min(0.0, velocity.dot(normal)) * normal;
  return true;
}

// Wall after wall corrects the path until none objects. A wall that moves may carry a particle into one that rests:
// there it may slide along.
Hold BoundaryParticles::hold_between(const Vec3& from, std::size_t cluster, Vec3& target, Vec3& velocity) const {
  constexpr int rounds = 4;
  const bool near_gap = near_gap_[cluster] != NearGap::none;
  const bool near_between = near_gap_[cluster] == NearGap::between;
  Hold result;
  for (int round = 0; round < rounds; ++round) {
    Hold now;
    const WallGuard::Crossing crossing = guard_.check(from, target, triangles_[cluster], near_gap);
    if (crossing.crossed) {
      now.held = true;
      velocity -= std::min(0.0, velocity.dot(crossing.normal)) * crossing.normal;
      const Vec3 way = target - from;
      target = round == 0 ? from : Vec3(from + way - std::min(0.0, way.dot(crossing.normal)) * crossing.normal);
    } else if (near_gap) {
      now.kept_out = keep_out(from, cluster, target, velocity);
    }
    for (const MovingWall& wall : movers_) now.add(wall.hold(from, cluster, target, velocity));
    if (near_between) now.kept_out = keep_out_between(from, cluster, target, velocity) || now.kept_out;
    if (!now.any()) return result;
    result.add(now);
  }
  // No way out between walls that close in. Those that rest hold.
  if (guard_.check(from, target, triangles_[cluster], near_gap).crossed) target = from;
  Vec3 end = target, unused = velocity;
  for (const MovingWall& wall : movers_) {
    result.squeezed_through = wall.hold(from, cluster, end, unused).held || result.squeezed_through;
  }
  return result;
}

// Where the walls leave no way around, the gap closes around the particle: it is free to leave.
bool BoundaryParticles::keep_out_between(const Vec3& from, std::size_t cluster, Vec3& target, Vec3& velocity) const {
  static const Pose rest;
  std::vector<MetWall> walls;
  walls.push_back({&guard_, &triangles_[cluster], &rest, &rest});
  for (const MovingWall& wall : movers_) walls.push_back(wall.met(from, cluster));
  const GapsBetween gaps(walls, gap_width_);
  const GapsBetween::Gap gap = gaps.enter(from, target);
  if (!gap.found) return false;
  for (const GapsBetween::Way& way : gaps.ways_around(gap, from, target)) {
    if (gaps.enter(from, way.to).found || stops(from, cluster, way.to)) continue;
    target = way.to;
    const Vec3 relative = velocity - walls[way.wall].velocity_at(target);
    velocity -= std::min(0.0, relative.dot(way.normal)) * way.normal;
    return true;
  }
  return false;
}

bool BoundaryParticles::stops(const Vec3& from, std::size_t cluster, const Vec3& target) const {
  return guard_.check(from, target, triangles_[cluster], near_gap_[cluster] != NearGap::none).crossed ||
         std::any_of(movers_.begin(), movers_.end(),
                     [&](const MovingWall& wall) { return wall.stops(from, cluster, target); });
}

bool BoundaryParticles::has_thin() const {
  return !thin_.empty() ||
         std::any_of(movers_.begin(), movers_.end(), [](const MovingWall& wall) { return wall.is_thin(); });
}

bool BoundaryParticles::hide(const PointClusters& points, const PointView& places, std::size_t cluster,
                             std::span<const std::uint32_t> sources, std::vector<std::uint8_t>& hidden) const {
  const PointCluster& own = points[cluster];
  const Vec3 center = origin_ + (0.5F * (own.box_min + own.box_max)).cast<double>();
  const bool near_resting = thin_.near(center);
  const auto near_mover = [&](const MovingWall& wall) { return wall.near_thin(center); };
  if (!near_resting && std::none_of(movers_.begin(), movers_.end(), near_mover)) return false;
  // In a periodic box the images nearest to the cluster.
  const auto place = [&](std::size_t k) {
    const Vec3 p = origin_ + places[k].cast<double>();
    return periodic_.any() ? Vec3(center + periodic_.shortest(p - center)) : p;
  };
  std::vector<Vec3> from, to;
  for (std::uint32_t lane = 0; lane < own.count; ++lane) from.push_back(place(own.first + lane));
  for (const std::uint32_t k : sources) to.push_back(place(k));
  if (near_resting) thin_.hide(from, to, hidden);
  for (const MovingWall& wall : movers_) {
    if (near_mover(wall)) wall.hide(from, to, hidden);
  }
  return true;
}

std::size_t BoundaryParticles::memory_bytes() const {
  std::size_t bytes = thin_.memory_bytes() + positions_.capacity() * sizeof(Vec3) +
                      packs_.capacity() * sizeof(WallPack) + adhesions_.capacity() * sizeof(float) +
                      clusters_.memory_bytes() + guard_.memory_bytes() +
                      triangles_.capacity() * sizeof(decltype(triangles_)::value_type) + near_gap_.capacity();
  for (const auto& triangles : triangles_) bytes += triangles.capacity() * sizeof(std::uint32_t);
  for (const MovingWall& wall : movers_) bytes += wall.memory_bytes();
  return bytes;
}

}  // namespace flowskin::sph
