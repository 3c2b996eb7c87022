// Where a scene's particles come from: one interface for simulation, prescribed motion and recorded sequences.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/state_archive.h"
#include "sph/geometry/triangle_mesh.h"
#include "tracking/particles.h"

namespace flowskin::scenes {

using sph::Vec3;

/// Particles at one time, in order of ascending id; all arrays have one entry per particle.
struct ParticleState {
  double time = 0;  ///< s
  std::vector<std::uint64_t> ids;
  std::vector<Vec3> positions;       ///< m
  std::vector<Vec3> velocities;      ///< m/s
  std::vector<Vec3> rest_positions;  ///< Place of the material in the first frame (m).
  std::vector<double> densities;     ///< kg/m^3; 0 where the source knows none
  /// Share of each particle in the field, where two recorded states are blended; empty: all of each.
  std::vector<double> weights{};
  std::vector<std::uint8_t> fluids{};  ///< Index of each particle's fluid; empty: there is only one
  std::vector<float> viscosities{};    ///< Kinematic (m^2/s); empty: the same for all
  std::size_t earlier_count = 0;       ///< Of blended states: so many particles, the first, are of the earlier one.
  bool has_velocities = true;          ///< false: unknown, and zero
  bool has_material = true;            ///< false: rest positions are unknown and stand for the positions
  bool has_lasting_ids = true;         ///< false: ids do not name the same particle in the next state
  tracking::Walls walls{};             ///< Of the scene; the same in all states, so not archived.

  template <class Archive>
  void visit(Archive& archive) {
    archive(time, ids, positions, velocities, rest_positions, densities, weights, fluids, viscosities, earlier_count);
    archive(has_velocities, has_material, has_lasting_ids);
  }
};

/// @throws StateError where the arrays of a state that was restored do not fit together.
void check_restored(const ParticleState& state);

/// What a source tells about itself in the log and in frames.csv; zero where it does not apply.
struct SourceStatistics {
  std::uint64_t steps = 0;
  std::uint64_t left_domain = 0;
  std::uint64_t emitted = 0, drained = 0;  ///< by emitters, by sinks
  std::uint64_t wall_crossings = 0, kept_out_of_gaps = 0;
  double kinetic_energy = 0;                                                  ///< J
  double potential_energy = 0;                                                ///< J
  double mean_density_error = 0, max_density_error = 0;                       ///< |density / rest density - 1|
  double last_time_step = 0;                                                  ///< s
  std::uint64_t not_wanted = 0, skipped_invalid = 0, skipped_duplicates = 0;  ///< of the recorded file at present
  std::string summary;  ///< One line for the log: settings chosen, limits of the step, memory.
  std::vector<std::pair<std::string, double>> seconds;  ///< Of computing time by stage, since the start.
};

/// A sequence of particle states; time only goes forward.
class ParticleSource {
 public:
  virtual ~ParticleSource() = default;
  /// Particles at the present time, which is 0 at the start.
  virtual const ParticleState& state() const = 0;
  /// Goes to `time` (s), not before the present one.
  virtual void advance_to(double time) = 0;
  /// The same, but may stop on the way where `stop` says so; then state() is still the one before, and calling it again
  /// goes on as if it had not stopped. @return false where it stopped
  virtual bool advance_towards(double time, const std::function<bool()>& stop) {
    (void)stop;
    advance_to(time);
    return true;
  }
  /// Distance of neighbouring particles (m).
  virtual double spacing() const = 0;
  virtual SourceStatistics statistics() const = 0;
  /// What of the scene is likely a slip.
  virtual std::vector<std::string> warnings() const { return {}; }
  /// True where the sequence ends before `time` (s): a recorded sequence that is too short.
  virtual bool ends_before(double) const { return false; }

  /// All that its future depends on but the scene. To go on later, make the source from the scene again and restore it.
  virtual void save(StateWriter& writer) const = 0;
  /// @throws StateError, InputError where the state is that of another source, or its files are not what they
  /// were.
  virtual void restore(StateReader& reader) = 0;
};

}  // namespace flowskin::scenes
