// Gaps between walls that move relative to each other, too narrow for a particle.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sph/walls/boundary_motion.h"
#include "sph/walls/wall_guard.h"

namespace flowskin::sph {

/// A wall as one particle meets it during one step: where it was and where it is. All resting walls are one.
struct MetWall {
  const WallGuard* guard;
  const std::vector<std::uint32_t>* triangles;  ///< Those of the guard around the path.
  const Pose *before, *now;
  Vec3 shift = Vec3::Zero();  ///< m, to the image of the particle that the triangles are tested against

  /// A place of the path, in the wall's own frame.
  Vec3 at_rest(const Vec3& from, const Vec3& to, double share) const;
  /// Where the start of a path would be now, carried along by the wall.
  Vec3 carried(const Vec3& from) const { return now->place(before->to_rest(from + shift)) - shift; }
  Vec3 velocity_at(const Vec3& x) const { return now->velocity_at(x + shift); }  ///< m/s
};

/// What WallGuard's own gaps are within one wall, between two: a place is in one where two walls are opposite each
/// other and nearer together there than `width` (m). Each wall sees a path in its own frame, so it does not matter
/// which of them moves, and how.
class GapsBetween {
 public:
  GapsBetween(std::span<const MetWall> walls, double width) : walls_(walls), width_(width) {}

  struct Gap {
    bool found = false;
    Vec3 out = Vec3::Zero();           ///< Leads out of the gap; of any length (m), none deep inside.
    std::array<std::size_t, 2> sides;  ///< The two walls.
  };
  /// The first gap that a path comes into; none where it begins in one: what starts in a gap is free to leave it.
  Gap enter(const Vec3& from, const Vec3& to) const;

  /// Where a particle may go instead.
  struct Way {
    Vec3 to;
    Vec3 normal;  ///< Unit vector; against it the velocity relative to `wall` is taken away.
    std::size_t wall;
  };
  /// In this order: along the gap's mouth, as that side sees it which asks for less, then the other; resting with one
  /// of its sides; farther out by a small share of its width.
  std::vector<Way> ways_around(const Gap& gap, const Vec3& from, const Vec3& to) const;

 private:
  Gap gap_at(const Vec3& from, const Vec3& to, double share) const;

  std::span<const MetWall> walls_;
  double width_;
};

}  // namespace flowskin::sph
