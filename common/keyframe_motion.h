// Rigid motion by keyframes, as walls move.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "common/vectors.h"

namespace flowskin {

/// Where a body is at one time, relative to where its shape was given.
struct Keyframe {
  double time = 0;                ///< s
  Vec3 translate = Vec3::Zero();  ///< m
  Vec3 rotate = Vec3::Zero();     ///< Degrees about x, then y, then z, about the pivot.
};

/// A rigid motion and its rate at one time: x = pivot + translation + rotation (p - pivot).
struct Pose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Vec3 translation = Vec3::Zero();       ///< m
  Vec3 velocity = Vec3::Zero();          ///< Of the pivot (m/s).
  Vec3 angular_velocity = Vec3::Zero();  ///< rad/s
  Vec3 pivot = Vec3::Zero();             ///< m, at rest

  Vec3 place(const Vec3& p) const { return pivot + translation + rotation * (p - pivot); }
  Vec3 to_rest(const Vec3& x) const { return pivot + rotation.transpose() * (x - pivot - translation); }
  /// Velocity (m/s) of the body's material at the place x.
  Vec3 velocity_at(const Vec3& x) const { return velocity + angular_velocity.cross(x - pivot - translation); }
};

/// Motion by keyframes in ascending time; before the first and after the last the body rests. Between two keyframes,
/// the translation is interpolated, and the rotation about one fixed axis: where just one of the three angles changes,
/// by that angle, which may be many turns; else by the shortest rotation from one to the other (the interpolation of
/// quaternions).
struct KeyframeMotion {
  /// linear: at constant speed. smooth: from rest to rest, along 3 s^2 - 2 s^3.
  enum class Interpolation { linear, smooth };

  std::vector<Keyframe> keyframes;  ///< Empty: the body rests.
  Interpolation interpolation = Interpolation::linear;
  Vec3 pivot = Vec3::Zero();  ///< m, in the place of the shape at rest

  bool moves() const { return !keyframes.empty(); }
  bool rotates() const;
  /// At a keyframe's own time the rate is that of what follows.
  Pose pose(double time) const;
  /// A bound of the speed (m/s) of all points that are at most `radius` (m) from the pivot, at all times.
  double greatest_speed(double radius) const;
};

}  // namespace flowskin
