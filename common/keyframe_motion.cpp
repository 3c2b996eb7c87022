#include "common/keyframe_motion.h"

#include <algorithm>
#include <cmath>

namespace flowskin {

namespace {

Eigen::AngleAxisd turn(double degrees, const Vec3& axis) { return {degrees * M_PI / 180, axis}; }

Eigen::Matrix3d rotation_of(const Vec3& degrees) {
  return (turn(degrees.z(), Vec3::UnitZ()) * turn(degrees.y(), Vec3::UnitY()) * turn(degrees.x(), Vec3::UnitX()))
      .toRotationMatrix();
}

// The rotation that leads from keyframe a to b, about an axis fixed in space.
Eigen::AngleAxisd rotation_between(const Keyframe& a, const Keyframe& b) {
  const Vec3 change = b.rotate - a.rotate;
  if ((change.array() != 0).count() <= 1) {
    if (change.x() != 0) {
      return turn(change.x(), turn(a.rotate.z(), Vec3::UnitZ()) * (turn(a.rotate.y(), Vec3::UnitY()) * Vec3::UnitX()));
    }
    if (change.y() != 0) return turn(change.y(), turn(a.rotate.z(), Vec3::UnitZ()) * Vec3::UnitY());
    return turn(change.z(), Vec3::UnitZ());
  }
  // Through quaternions, whose angle is precise for small rotations too.
  Eigen::Quaterniond q(rotation_of(b.rotate) * rotation_of(a.rotate).transpose());
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  return Eigen::AngleAxisd(q);
}

}  // namespace

bool KeyframeMotion::rotates() const {
  return std::any_of(keyframes.begin(), keyframes.end(), [](const Keyframe& k) { return !k.rotate.isZero(0); });
}

Pose KeyframeMotion::pose(double time) const {
  Pose pose;
  pose.pivot = pivot;
  if (keyframes.empty()) return pose;
  const auto next = std::upper_bound(keyframes.begin(), keyframes.end(), time,
                                     [](double t, const Keyframe& key) { return t < key.time; });
  const Keyframe& a = next == keyframes.begin() ? *next : *(next - 1);
  pose.translation = a.translate;
  pose.rotation = rotation_of(a.rotate);
  if (next == keyframes.begin() || next == keyframes.end()) return pose;
  const Keyframe& b = *next;
  const double u = (time - a.time) / (b.time - a.time);
  const bool smooth = interpolation == Interpolation::smooth;
  const double share = smooth ? u * u * (3 - 2 * u) : u;
  const double rate = (smooth ? 6 * u * (1 - u) : 1) / (b.time - a.time);
  const Eigen::AngleAxisd turned = rotation_between(a, b);
  pose.translation += share * (b.translate - a.translate);
  pose.velocity = rate * (b.translate - a.translate);
  pose.rotation = Eigen::AngleAxisd(share * turned.angle(), turned.axis()) * pose.rotation;
  pose.angular_velocity = rate * turned.angle() * turned.axis();
  return pose;
}

double KeyframeMotion::greatest_speed(double radius) const {
  double speed = 0;
  for (std::size_t k = 1; k < keyframes.size(); ++k) {
    const Keyframe &a = keyframes[k - 1], &b = keyframes[k];
    const double path = (b.translate - a.translate).norm() + std::abs(rotation_between(a, b).angle()) * radius;
    speed = std::max(speed, (interpolation == Interpolation::smooth ? 1.5 : 1) * path / (b.time - a.time));
  }
  return speed;
}

}  // namespace flowskin
