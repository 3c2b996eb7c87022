// Where particles are between two states.
#pragma once

#include <limits>
#include <vector>

#include "tracking/field/metaballs/metaball_field.h"
#include "tracking/particles.h"

namespace flowskin::tracking {

/// @throws std::invalid_argument where arrays differ in size, ids do not ascend, or a number is not finite.
void check_particles(const Particles& particles);

/// The field of particles and walls at one time; with time derivatives as far as the particles have velocities.
MetaballField field_of(const Particles& particles, const FieldSettings& settings);

/// Particles of two states matched by id. A particle in both moves on the cubic Hermite curve through its positions
/// with its velocities; one only in the later state comes in on a straight line, one only in the earlier goes on on
/// one. A particle that jumps (JumpRule) counts as two: one that goes, and one that comes.
///
/// Where ids do not last, or velocities are unknown, paths are unknown. Then the field itself goes from one state's to
/// the other's, f = (1 - s) f_0 + s f_1 with s from 0 to 1; particles with velocities move in it, those of the earlier
/// state forward, those of the later one backward in time from where they are. Time derivatives are those of this
/// blend.
class ParticlePaths {
 public:
  /// Both states are as check_particles wants them.
  /// @param spacing of the particles (m), by which jumps are told; infinite: none jumps
  ParticlePaths(const Particles& from, const Particles& to, double spacing = std::numeric_limits<double>::infinity());

  double begin_time() const { return begin_; }
  double end_time() const { return end_; }
  /// True where the field is blended between the states.
  bool blended() const { return blended_; }
  /// True where some particle jumps.
  bool jumps() const { return jumps_; }

  /// Positions and velocities at a time between both states; only where they are not blended. At end_time() only the
  /// particles of the later state are left, exactly as they are given there.
  void at(double time, std::vector<Vec3>& positions, std::vector<Vec3>& velocities) const;

  /// The field of these particles, and of the later state's walls where they are at that time. Blended: the particles
  /// of the later state come first.
  MetaballField field(double time, const FieldSettings& settings) const;

  /// An upper bound of how far any particle moves from begin to end along its path (m). Blended: an estimate.
  double longest_path() const;
  /// Blended: how far (nearly all) particles of the earlier state, moved by their velocities, end from any of the later
  /// one (m). A blend over more than about half the effective radius shows the body twice instead of moving it. Else 0.
  double mismatch() const { return mismatch_; }

 private:
  struct Path {
    Vec3 x0, v0, x1, v1;  // at both ends
    bool ends;            // not in the later state
  };
  void match(const Particles& from, const Particles& to, double spacing);

  double begin_, end_;
  bool blended_ = false, jumps_ = false;
  double mismatch_ = 0;
  std::vector<Path> paths_;              // in order of ascending id
  std::vector<FieldPart> early_, late_;  // blended: of both states
  Walls walls_;                          // of the later state
};

}  // namespace flowskin::tracking
