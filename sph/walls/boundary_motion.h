// How a wall moves: rigid motion by keyframes.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "sph/geometry/triangle_mesh.h"

namespace flowskin::sph {

/// Where a wall is at one time, relative to its mesh.
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
  /// Velocity (m/s) of the wall's material at the place x.
  Vec3 velocity_at(const Vec3& x) const { return velocity + angular_velocity.cross(x - pivot - translation); }
};

/// Motion by keyframes in ascending time; before the first and after the last the wall rests. Between two keyframes,
/// the translation is interpolated, and the rotation about one fixed axis: where just one of the three angles changes,
/// by that angle, which may be many turns; else by the shortest rotation from one to the other (the interpolation of
/// quaternions).
struct BoundaryMotion {
  /// linear: at constant speed. smooth: from rest to rest, along 3 s^2 - 2 s^3.
  enum class Interpolation { linear, smooth };

  std::vector<Keyframe> keyframes;  ///< Empty: the wall rests.
  Interpolation interpolation = Interpolation::linear;
  Vec3 pivot = Vec3::Zero();  ///< m, in the place of the mesh at rest

  bool moves() const { return !keyframes.empty(); }
  bool rotates() const;
  /// At a keyframe's own time the rate is that of what follows.
  Pose pose(double time) const;
  /// A bound of the speed (m/s) of all points that are at most `radius` (m) from the pivot, at all times.
  double greatest_speed(double radius) const;
};

/// The mesh at a time.
TriangleMesh placed(const TriangleMesh& mesh, const BoundaryMotion& motion, double time);

}  // namespace flowskin::sph
