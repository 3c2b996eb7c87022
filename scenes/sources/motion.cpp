#include "scenes/sources/motion.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "scenes/nearest_name.h"
#include "scenes/scene_file.h"

namespace flowskin::scenes {
namespace {

using std::numbers::pi;

Vec3 rotation_field(const MotionSpec& m, const Vec3& x) { return m.angular_velocity.cross(x - m.center); }
Vec3 rotation_path(const MotionSpec& m, const Vec3& x, double t) {
  const double speed = m.angular_velocity.norm();
  if (speed == 0) return x;
  return m.center + Eigen::AngleAxisd(speed * t, m.angular_velocity / speed) * (x - m.center);
}

Vec3 translation_field(const MotionSpec&, const Vec3&) { return Vec3::Zero(); }
Vec3 translation_path(const MotionSpec&, const Vec3& x, double) { return x; }

Vec3 shear_field(const MotionSpec& m, const Vec3& x) { return {m.rate * x.y(), 0, 0}; }
Vec3 shear_path(const MotionSpec& m, const Vec3& x, double t) { return {x.x() + m.rate * x.y() * t, x.y(), x.z()}; }

Vec3 stretch_field(const MotionSpec& m, const Vec3& x) {
  return m.rate * Vec3(1, -0.5, -0.5).cwiseProduct(x - m.center);
}
Vec3 stretch_path(const MotionSpec& m, const Vec3& x, double t) {
  const double across = std::exp(-0.5 * m.rate * t);
  return m.center + Vec3(std::exp(m.rate * t), across, across).cwiseProduct(x - m.center);
}

Vec3 vortex_field(const MotionSpec& m, const Vec3& x) {
  const double px = pi * x.x(), py = pi * x.y();
  return m.rate * Vec3(-std::sin(px) * std::cos(py), std::cos(px) * std::sin(py), 0);
}

struct MotionInfo {
  const char* name;
  Vec3 (*field)(const MotionSpec&, const Vec3&);
  Vec3 (*path)(const MotionSpec&, const Vec3&, double);  ///< nullptr: by integration
};

constexpr MotionInfo motions[] = {
    {"rotation", rotation_field, rotation_path}, {"translation", translation_field, translation_path},
    {"shear", shear_field, shear_path},          {"stretch", stretch_field, stretch_path},
    {"vortex", vortex_field, nullptr},
};

}  // namespace

std::vector<std::string> motion_names() {
  std::vector<std::string> names;
  for (const MotionInfo& motion : motions) names.emplace_back(motion.name);
  return names;
}

Motion::Motion(const MotionSpec& spec) : spec_(spec) {
  for (const MotionInfo& motion : motions) {
    if (spec.type != motion.name) continue;
    field_ = motion.field;
    path_ = motion.path;
  }
  if (!field_) {
    throw SceneError("particles.motion.type: there is no motion \"" + spec.type + "\"" +
                     did_you_mean(spec.type, motion_names()));
  }
}

Vec3 Motion::velocity(const Vec3& position, double time) const {
  return field_(spec_, position - time * spec_.velocity) + spec_.velocity;
}

double Motion::integration_step() const {
  // The gradient of the vortex is pi |rate| at most; with RK4 the error of a step is about (step * gradient)^5 / 120.
  const double gradient = pi * std::abs(spec_.rate);
  return gradient > 0 ? 0.02 / gradient : 1.0;
}

}  // namespace flowskin::scenes
