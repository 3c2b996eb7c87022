// Particles that keep their id, but are taken out in one place and put in at another.
#pragma once

#include <vector>

#include "tracking/particles.h"

namespace flowskin::tracking {

/// When a particle that is found again by its id has not moved there: at a periodic boundary, or where an emitter uses
/// its particles again. Measured from where it is expected: its velocities lead it there, or, where they are unknown,
/// it goes as far as the median particle does.
struct JumpRule {
  /// Spacings from the place that velocities lead to. An impact stays below one, a missed frame of a splash below
  /// three.
  double shortest = 4;
  double shortest_without_velocities = 10;  ///< The same from where the median particle goes.
  /// Lengths of the path that velocities tell: a particle that turns back at a wall is off by one at most, one that
  /// circles by two.
  double paths = 2;
  double usual_errors = 8;  ///< Times the distance within which nine in ten particles are.
};

/// A particle that is in two states.
struct Sighting {
  Vec3 displacement;           ///< From the earlier to the later place (m).
  Vec3 before = Vec3::Zero();  ///< Velocity in the earlier state (m/s).
  Vec3 after = Vec3::Zero();   ///< Velocity in the later state (m/s).
};

/// Which of the particles have jumped: what is left has moved. One entry per particle; empty where none has jumped.
/// @param duration from the earlier to the later state (s)
/// @param has_velocities whether the velocities are known
/// @param spacing of the particles (m)
std::vector<char> jumped(const std::vector<Sighting>& particles, double duration, bool has_velocities, double spacing,
                         const JumpRule& rule = {});

}  // namespace flowskin::tracking
