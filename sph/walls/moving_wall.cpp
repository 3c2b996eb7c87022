#include "sph/walls/moving_wall.h"

#include <algorithm>

namespace flowskin::sph {

namespace {

Vec3 corner(const Vec3& low, const Vec3& high, int k) {
  return {(k & 1 ? high : low).x(), (k & 2 ? high : low).y(), (k & 4 ? high : low).z()};
}

}  // namespace

MovingWall::MovingWall(const BoundaryMotion& motion, const Vec3& surface_velocity, const TriangleMesh& mesh,
                       std::vector<Vec3> rest_positions, std::size_t first, double sample_spacing, double spacing,
                       double reach, const PeriodicBox& periodic)
    : motion_(motion),
      rotates_(motion.rotates()),
      surface_velocity_(surface_velocity),
      periodic_(periodic),
      rest_positions_(std::move(rest_positions)),
      first_(first),
      guard_({mesh}, 2 * spacing, rotates_ ? PeriodicBox() : periodic),
      rest_box_{Vec3::Constant(1e300), Vec3::Constant(-1e300)},
      before_(motion.pose(0)),
      now_(before_),
      build_(before_) {
  for (const Vec3& p : mesh.positions) {
    rest_box_.min = rest_box_.min.cwiseMin(p);
    rest_box_.max = rest_box_.max.cwiseMax(p);
  }
  thin_ = ThinWalls({mesh}, guard_, spacing, reach, rotates_ ? PeriodicBox() : periodic);
  guard_.find_gaps(rest_positions_, sample_spacing, spacing, rotates_ ? PeriodicBox() : periodic);
}

void MovingWall::move_to(double time) {
  before_ = now_;
  now_ = motion_.pose(time);
}

double MovingWall::greatest_speed() const {
  double radius = 0;
  for (int k = 0; k < 8; ++k) {
    radius = std::max(radius, (corner(rest_box_.min, rest_box_.max, k) - motion_.pivot).norm());
  }
  return motion_.greatest_speed(radius);
}

// The way is a convex function of the point, so it is greatest at a corner of a box around all.
double MovingWall::farthest_shift(const Pose& since) const {
  double farthest = 0;
  for (int k = 0; k < 8; ++k) {
    const Vec3 p = corner(rest_box_.min, rest_box_.max, k);
    farthest = std::max(farthest, (now_.place(p) - since.place(p)).norm());
  }
  return farthest;
}

Vec3 MovingWall::image_shift(const Vec3& place, const Pose& pose) const {
  if (!periodic_.any()) return Vec3::Zero();
  // Without rotation shifts of the images are the same in the wall's frame; a wall that turns is smaller than the
  // period, and the image nearest to its pivot counts.
  const Vec3 p = rotates_ ? Vec3(place - pose.pivot - pose.translation) : pose.to_rest(place);
  return (rotates_ ? periodic_.shortest(p) : periodic_.wrap(p)) - p;
}

void MovingWall::mark_build(std::size_t clusters) {
  build_ = now_;
  triangles_.resize(clusters);
  for (auto& triangles : triangles_) triangles.clear();
  near_gap_.assign(clusters, 0);
}

Box MovingWall::box_at_rest(const Vec3& low, const Vec3& high) const {
  const Vec3 shift = image_shift(0.5 * (low + high), now_);
  Box box{Vec3::Constant(1e300), Vec3::Constant(-1e300)};
  for (int k = 0; k < 8; ++k) {
    const Vec3 p = now_.to_rest(corner(low, high, k) + shift);
    box.min = box.min.cwiseMin(p);
    box.max = box.max.cwiseMax(p);
  }
  return box;
}

bool MovingWall::collect_triangles(std::size_t cluster, const Vec3& low, const Vec3& high, double margin) {
  const Box box = box_at_rest(low, high);
  near_gap_[cluster] = guard_.collect(box.min, box.max, margin, triangles_[cluster]);
  return near_gap_[cluster] != 0;
}

void MovingWall::find_triangles(const Vec3& low, const Vec3& high, std::vector<std::uint32_t>& found) const {
  const Box box = box_at_rest(low, high);
  guard_.query_touching(box.min, box.max, found);
}

void MovingWall::mark_gap(std::size_t cluster, const std::vector<std::uint32_t>& triangles) {
  triangles_[cluster] = triangles;
  near_gap_[cluster] = 1;
}

Hold MovingWall::hold(const Vec3& from, std::size_t cluster, Vec3& target, Vec3& velocity) const {
  if (triangles_[cluster].empty()) return {};
  const bool near_gap = near_gap_[cluster] != 0;
  const Vec3 shift = image_shift(from, before_);
  const Vec3 start = before_.to_rest(from + shift);
  Vec3 end = now_.to_rest(target + shift);
  WallGuard::Crossing crossing = guard_.check(start, end, triangles_[cluster], near_gap);
  Hold result{.held = crossing.crossed};
  if (crossing.crossed) end = start;
  if (!crossing.crossed && near_gap) {
    result.kept_out = guard_.keep_out(start, triangles_[cluster], end, crossing.normal);
  }
  if (!result.any()) return result;
  target = now_.place(end) - shift;
  const Vec3 normal = now_.rotation * crossing.normal;
  velocity -= std::min(0.0, (velocity - now_.velocity_at(target + shift)).dot(normal)) * normal;
  return result;
}

bool MovingWall::stops(const Vec3& from, std::size_t cluster, const Vec3& target) const {
  const MetWall wall = met(from, cluster);
  return guard_
      .check(wall.at_rest(from, target, 0), wall.at_rest(from, target, 1), triangles_[cluster], near_gap_[cluster] != 0)
      .crossed;
}

MetWall MovingWall::met(const Vec3& from, std::size_t cluster) const {
  return {&guard_, &triangles_[cluster], &before_, &now_, image_shift(from, before_)};
}

bool MovingWall::near_thin(const Vec3& center) const {
  return !thin_.empty() && thin_.near(now_.to_rest(center + image_shift(center, now_)));
}

void MovingWall::hide(std::span<const Vec3> targets, std::span<const Vec3> sources,
                      std::vector<std::uint8_t>& hidden) const {
  const Vec3 shift = image_shift(targets[0], now_);
  std::vector<Vec3> at_rest;
  for (const Vec3& p : targets) at_rest.push_back(now_.to_rest(p + shift));
  for (const Vec3& p : sources) at_rest.push_back(now_.to_rest(p + shift));
  const std::span<const Vec3> places = at_rest;
  thin_.hide(places.first(targets.size()), places.subspan(targets.size()), hidden);
}

std::size_t MovingWall::memory_bytes() const {
  std::size_t bytes = thin_.memory_bytes() + rest_positions_.capacity() * sizeof(Vec3) + guard_.memory_bytes() +
                      triangles_.capacity() * sizeof(decltype(triangles_)::value_type) + near_gap_.capacity();
  for (const auto& triangles : triangles_) bytes += triangles.capacity() * sizeof(std::uint32_t);
  return bytes;
}

}  // namespace flowskin::sph
