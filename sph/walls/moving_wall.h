// A wall that moves: its boundary particles and triangles, carried along by its motion.
#pragma once

#include <cstdint>
#include <vector>

#include "sph/geometry/periodic_box.h"
#include "sph/walls/boundary_motion.h"
#include "sph/walls/gaps_between.h"
#include "sph/walls/thin_walls.h"
#include "sph/walls/wall_guard.h"

namespace flowskin::sph {

/// The guard works in the wall's own frame, where its triangles rest: a path from where the particle was at the start
/// of a step, seen from the wall as it was then, to where it is at the end, seen from the wall as it is then. So a wall
/// that sweeps over a particle is noticed as surely as a particle that runs into a wall, and paths of successive steps
/// join without a gap.
class MovingWall {
 public:
  /// @param rest_positions its boundary particles (m), without motion
  /// @param first index of the first of them among all boundary particles
  /// @param sample_spacing distance of the boundary particles (m)
  /// @param spacing of the fluid (m)
  /// @param reach of the fluid's lists (m)
  MovingWall(const BoundaryMotion& motion, const Vec3& surface_velocity, const TriangleMesh& mesh,
             std::vector<Vec3> rest_positions, std::size_t first, double sample_spacing, double spacing, double reach,
             const PeriodicBox& periodic);

  /// From where it is to where it is at `time`.
  void move_to(double time);
  const Pose& pose() const { return now_; }
  std::size_t first() const { return first_; }
  std::size_t count() const { return rest_positions_.size(); }
  Vec3 position(std::size_t k) const { return now_.place(rest_positions_[k]); }
  /// Velocity that fluid at its k-th particle should have (m/s): that of the wall, and of its surface on it.
  Vec3 velocity(std::size_t k) const { return now_.velocity_at(position(k)) + now_.rotation * surface_velocity_; }
  /// Farthest way (m) that any of its points has gone in the last move, and since the last call of mark_build().
  double last_shift() const { return farthest_shift(before_); }
  double shift_since_build() const { return farthest_shift(build_); }
  double greatest_speed() const;

  /// Prepares hold() for clusters of particles, by their boxes (m) and the way that they may go.
  void mark_build(std::size_t clusters);
  /// Says whether a gap of this wall is near.
  bool collect_triangles(std::size_t cluster, const Vec3& low, const Vec3& high, double margin);
  /// Triangles that may touch the box (m) where the wall is now.
  void find_triangles(const Vec3& low, const Vec3& high, std::vector<std::uint32_t>& found) const;
  /// A gap between this wall and another is near: takes a wider choice of triangles.
  void mark_gap(std::size_t cluster, const std::vector<std::uint32_t>& triangles);

  /// Where a particle's path in the last move passes this wall: puts its end back to the side where it began, carried
  /// along with the wall, and takes the velocity towards the wall away. Keeps it out of the wall's narrow gaps, too.
  Hold hold(const Vec3& from, std::size_t cluster, Vec3& target, Vec3& velocity) const;

  /// Whether a path in the last move passes this wall.
  bool stops(const Vec3& from, std::size_t cluster, const Vec3& target) const;
  /// This wall as a particle meets it that was at `from` before the last move.
  MetWall met(const Vec3& from, std::size_t cluster) const;

  /// As ThinWalls, with places where the wall is now.
  bool is_thin() const { return !thin_.empty(); }
  bool near_thin(const Vec3& center) const;
  void hide(std::span<const Vec3> targets, std::span<const Vec3> sources, std::vector<std::uint8_t>& hidden) const;

  std::size_t memory_bytes() const;

 private:
  double farthest_shift(const Pose& since) const;
  /// Box in the wall's own frame around one where it is now.
  Box box_at_rest(const Vec3& low, const Vec3& high) const;
  /// Shift (m) to the image of a place that the triangles at rest are tested against.
  Vec3 image_shift(const Vec3& place, const Pose& pose) const;

  BoundaryMotion motion_;
  bool rotates_;
  Vec3 surface_velocity_;
  PeriodicBox periodic_;
  std::vector<Vec3> rest_positions_;
  std::size_t first_;
  WallGuard guard_;
  ThinWalls thin_;
  Box rest_box_;
  Pose before_, now_, build_;
  std::vector<std::vector<std::uint32_t>> triangles_;  // one list per cluster
  std::vector<std::uint8_t> near_gap_;                 // one entry per cluster
};

}  // namespace flowskin::sph
