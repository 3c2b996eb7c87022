// Prescribed motions: analytic velocity fields, most of them with known paths.
#pragma once

#include <string>
#include <vector>

#include "scenes/scene.h"

namespace flowskin::scenes {

/// Names of all motions, in the order of docs/scenes.md, which gives their formulas.
std::vector<std::string> motion_names();

/// A motion by its name. Every motion is a local field v0 that is carried along by the translation u = spec.velocity:
/// v(x, t) = v0(x - u t, t) + u, so that a path is x(t) = p(t) + u t with dp/dt = v0(p, t).
class Motion {
 public:
  /// @throws InputError where there is no motion of this name.
  explicit Motion(const MotionSpec& spec);

  /// Velocity at a place and time (m/s).
  Vec3 velocity(const Vec3& position, double time) const;
  /// The field v0, in the frame that moves with the translation (m/s).
  Vec3 local_velocity(const Vec3& position, double time) const { return field_(spec_, position, time); }
  bool has_closed_form() const { return path_ != nullptr; }
  /// Place at `time` of what is at `start` at time 0, in the moving frame; only where there is a closed form.
  /// At time 0 it is `start`, to the last bit.
  Vec3 local_path(const Vec3& start, double time) const { return time == 0 ? start : path_(spec_, start, time); }
  const MotionSpec& spec() const { return spec_; }
  /// Fixed time step with which paths without closed form are integrated (s), a small share of the motion's own time.
  double integration_step() const;

 private:
  MotionSpec spec_;
  Vec3 (*field_)(const MotionSpec&, const Vec3& position, double time) = nullptr;
  Vec3 (*path_)(const MotionSpec&, const Vec3& start, double time) = nullptr;
  double (*gradient_)(const MotionSpec&) = nullptr;
};

}  // namespace flowskin::scenes
