#include "tools/experiments/material_motion.h"

#include <fmt/format.h>

#include <numbers>
#include <utility>

#include "common/errors.h"
#include "scenes/sources/make_source.h"
#include "tools/pipeline/tracker_bridge.h"

namespace flowskin::tools {
namespace {

double period_of(const scenes::Scene& scene) {
  const double speed = scene.particles.motion.angular_velocity.norm();
  if (scene.particles.motion.type == "rotation" && speed > 0) return 2 * std::numbers::pi / speed;
  return scene.frames / scene.frame_rate;
}

}  // namespace

MaterialMotion::MaterialMotion(const scenes::Scene& scene)
    : motion_(scene.particles.motion), settings_(scenes::settings_in_metres(scene).field), period_(period_of(scene)) {
  if (scene.particles.source != scenes::ParticlesSpec::Source::prescribed || !motion_.has_closed_form())
    throw InputError(
        fmt::format("scene {}: this experiment needs particles.source \"prescribed\" and a motion whose paths are "
                    "known in closed form",
                    scene.name));
  starts_ = scenes::make_source(scene)->state().positions;
}

tracking::MetaballField MaterialMotion::field(double time) const {
  std::vector<Vec3> positions, velocities;
  for (const Vec3& start : starts_) {
    positions.push_back(moved(start, time));
    velocities.push_back(motion_.velocity(positions.back(), time));
  }
  return {std::move(positions), std::move(velocities), settings_};
}

Vec3 MaterialMotion::position(const Vec3& start, double time, Truth truth) const {
  if (truth == Truth::unspinning) return start + moved(starts_.front(), time) - starts_.front();
  return moved(start, time);
}

Vec3 MaterialMotion::velocity(const Vec3& place, double time, Truth truth) const {
  return motion_.velocity(truth == Truth::unspinning ? moved(starts_.front(), time) : place, time);
}

}  // namespace flowskin::tools
