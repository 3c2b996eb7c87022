// Walls: points on them that make a metaball field stronger beside them.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "common/keyframe_motion.h"
#include "tracking/particles.h"

namespace flowskin::tracking {

class ParticleBlocks;
struct FieldSettings;

/// Points on a wall that add their kernels to the field of the fluid beside it. The fluid ends at the wall, and its
/// field with it: a film of one layer of particles hardly reaches the threshold, so its surface tears where the fluid
/// does not. The points stand for what the wall leaves out. They are no particles: nobody meets them as neighbours, and
/// no velocity or material is read from them. The surface lies up to half a spacing within the wall, where nobody sees
/// it.
class FieldWall {
 public:
  /// @param share factor of the points' weights, see share_of_wall_point
  /// @param radius effective radius of the field (m)
  /// @throws std::invalid_argument where a number is not finite, the share negative, or the radius not positive
  FieldWall(std::vector<Vec3> positions, double share, double radius);
  ~FieldWall();

  const std::vector<Vec3>& positions() const { return positions_; }  ///< m
  double share() const { return share_; }
  /// All points nearer than `reach` (m) to the box from `low` to `high`, and some others. Clears `found` first.
  void near(const Vec3& low, const Vec3& high, double reach, std::vector<Vec3>& found) const;

  /// Internal to tracking/field.
  const std::shared_ptr<const ParticleBlocks>& blocks() const { return blocks_; }

 private:
  std::vector<Vec3> positions_;
  double share_;
  std::shared_ptr<const ParticleBlocks> blocks_;
};

/// All walls at one time.
using FieldWalls = std::vector<std::shared_ptr<const FieldWall>>;

/// A wall as a source hands it out with its particles: points in the wall's own frame, and the motion that tells where
/// they are at any time, so also between two states. Shared by all states of a source; safe to use from many threads.
class Wall {
 public:
  /// @param points about evenly spread over the wall where its mesh is at rest (m)
  /// @param area that a point stands for (m^2)
  /// @throws std::invalid_argument where a point is not finite, or the area not positive
  Wall(std::vector<Vec3> points, double area, KeyframeMotion motion = {});
  ~Wall();

  const std::vector<Vec3>& points() const { return points_; }
  double area() const { return area_; }
  const KeyframeMotion& motion() const { return motion_; }
  /// As the field of these settings meets it at a time (s). The last answer is kept: of a wall that rests, and of one
  /// that is asked for again at the same time, nothing is worked out twice.
  std::shared_ptr<const FieldWall> in_field(double time, const FieldSettings& settings) const;

 private:
  std::vector<Vec3> points_;
  double area_;
  KeyframeMotion motion_;
  struct Answer;
  mutable std::mutex mutex_;
  mutable std::unique_ptr<const Answer> last_;
};

/// What a metaball field meets of the walls at a time (s); nothing where FieldSettings::wall_share is 0.
FieldWalls field_walls(const Walls& walls, double time, const FieldSettings& settings);

/// The share that makes the field of points on a bare plane `share_of_threshold` times the threshold there. Below 1/2
/// neither a wall nor the gap between two makes a surface of its own.
/// @param area that a point stands for (m^2)
double share_of_wall_point(const FieldSettings& settings, double area, double share_of_threshold);

}  // namespace flowskin::tracking
