// Where particles are between two states.
#pragma once

#include <vector>

#include "tracking/field/metaball_field.h"
#include "tracking/particles.h"

namespace flowskin::tracking {

/// @throws std::invalid_argument where arrays differ in size, ids do not ascend, or a number is not finite.
void check_particles(const Particles& particles);

/// Particles of two states matched by id. A particle in both moves on the cubic Hermite curve through its positions
/// with its velocities; one only in the later state comes in on a straight line, one only in the earlier goes on on
/// one.
class ParticlePaths {
 public:
  /// Both states are as check_particles wants them.
  ParticlePaths(const Particles& from, const Particles& to);

  double begin_time() const { return begin_; }
  double end_time() const { return end_; }

  /// Positions and velocities at a time between both states. At end_time() only the particles of the later state are
  /// left, exactly as they are given there.
  void at(double time, std::vector<Vec3>& positions, std::vector<Vec3>& velocities) const;

  /// The field of these particles.
  MetaballField field(double time, const FieldSettings& settings) const;

  /// An upper bound of how far any particle moves from begin to end along its path (m).
  double longest_path() const;

 private:
  struct Path {
    Vec3 x0, v0, x1, v1;  // at both ends
    bool ends;            // not in the later state
  };
  double begin_, end_;
  std::vector<Path> paths_;  // in order of ascending id
};

}  // namespace flowskin::tracking
