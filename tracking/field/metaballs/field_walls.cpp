#include "tracking/field/metaballs/field_walls.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include "common/number_text.h"
#include "tracking/field/metaballs/metaball_field.h"
#include "tracking/field/metaballs/particle_blocks.h"

namespace flowskin::tracking {
namespace {

void check(const std::vector<Vec3>& positions, double share, double radius) {
  if (!std::all_of(positions.begin(), positions.end(), [](const Vec3& x) { return x.allFinite(); }))
    throw std::invalid_argument("FieldWall: a position is not finite; check the wall's mesh and motion");
  if (!(std::isfinite(share) && share >= 0 && std::isfinite(radius) && radius > 0))
    throw std::invalid_argument("FieldWall: share is " + number_text(share, 4) + ", radius " + number_text(radius, 4) +
                                "; expected a number that is not negative and a positive length (m)");
}

}  // namespace

FieldWall::FieldWall(std::vector<Vec3> positions, double share, double radius)
    : positions_(std::move(positions)), share_(share) {
  check(positions_, share, radius);
  blocks_ = std::make_shared<const ParticleBlocks>(positions_, std::vector<Vec3>{}, radius);
}
FieldWall::~FieldWall() = default;

void FieldWall::near(const Vec3& low, const Vec3& high, double reach, std::vector<Vec3>& found) const {
  found.clear();
  thread_local std::vector<int> boxes;
  blocks_->boxes_near(low, high, reach, boxes);
  for (const int box : boxes) {
    for (int group = box * lane_count; group < (box + 1) * lane_count; ++group) {
      for (int lane = 0; lane < lane_count; ++lane) {
        const int point = blocks_->particle(group, lane);
        if (point >= 0) found.push_back(positions_[point]);
      }
    }
  }
}

/// Where a wall was last asked for, and what it was there.
struct Wall::Answer {
  double time;  // s; of a wall that rests without meaning
  double share, radius;
  std::shared_ptr<const FieldWall> wall;
};

Wall::Wall(std::vector<Vec3> points, double area, KeyframeMotion motion)
    : points_(std::move(points)), area_(area), motion_(std::move(motion)) {
  check(points_, 0, 1);
  if (!(std::isfinite(area_) && area_ > 0))
    throw std::invalid_argument("Wall: the area that a point stands for is " + number_text(area_, 4) +
                                "; expected a positive number (m^2)");
}
Wall::~Wall() = default;

std::shared_ptr<const FieldWall> Wall::in_field(double time, const FieldSettings& settings) const {
  const double share = share_of_wall_point(settings, area_, settings.wall_share);
  const std::lock_guard lock(mutex_);
  if (last_ && last_->share == share && last_->radius == settings.radius && (!motion_.moves() || last_->time == time))
    return last_->wall;
  std::vector<Vec3> places = points_;
  if (motion_.moves()) {
    const Pose pose = motion_.pose(time);
    for (Vec3& place : places) place = pose.place(place);
  }
  last_ = std::make_unique<const Answer>(Answer{
      time, share, settings.radius, std::make_shared<const FieldWall>(std::move(places), share, settings.radius)});
  return last_->wall;
}

FieldWalls field_walls(const Walls& walls, double time, const FieldSettings& settings) {
  FieldWalls placed;
  if (!(settings.wall_share > 0)) return placed;
  for (const auto& wall : walls) placed.push_back(wall->in_field(time, settings));
  return placed;
}

double share_of_wall_point(const FieldSettings& settings, double area, double share_of_threshold) {
  // Integral of (1 - r^2 / sigma^2)^3 over a plane through the centre.
  const double plane = std::numbers::pi / 4 * settings.radius * settings.radius;
  return share_of_threshold * settings.threshold / (settings.weight * plane / area);
}

}  // namespace flowskin::tracking
