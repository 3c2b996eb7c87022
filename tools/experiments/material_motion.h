// Where the material of a prescribed motion is: the truth that the carried mesh is compared with.
#pragma once

#include "scenes/scene.h"
#include "scenes/sources/motion.h"
#include "tools/frame_data.h"
#include "tracking/field/metaballs/metaball_field.h"

namespace flowskin::tools {

/// What is taken as true. They have the same particle paths and so the same field, but not the same material motion.
enum class Truth {
  motion,     ///< Material follows the scene's motion: a rotation turns it about its own centre as well.
  unspinning  ///< Material moves in parallel with the first particle, whatever the motion does around it.
};

/// Particles, field and material of a scene with a prescribed motion that has closed-form paths, at any time.
class MaterialMotion {
 public:
  /// @throws InputError where the scene's motion has no closed form; InputError where it has no particles.
  explicit MaterialMotion(const scenes::Scene& scene);

  /// The exact field at a time (s).
  tracking::MetaballField field(double time) const;
  const tracking::FieldSettings& field_settings() const { return settings_; }

  /// Place at `time` of what is at `start` at time 0 (m).
  Vec3 position(const Vec3& start, double time, Truth truth = Truth::motion) const;
  /// True velocity of the material at a place and time (m/s).
  Vec3 velocity(const Vec3& place, double time, Truth truth = Truth::motion) const;

  /// Time of a revolution of a rotation (s), else the duration of the scene.
  double period() const { return period_; }

 private:
  Vec3 moved(const Vec3& start, double time) const {
    return motion_.local_path(start, time) + time * motion_.spec().velocity;
  }

  scenes::Motion motion_;
  std::vector<Vec3> starts_;  // of the particles
  tracking::FieldSettings settings_;
  double period_;
};

}  // namespace flowskin::tools
