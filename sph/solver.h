// A weakly compressible SPH fluid: the public face of the solver. Users include only this; files of the solver itself
// never do.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/state_archive.h"
#include "sph/setup/errors.h"
#include "sph/setup/simulation_setup.h"
#include "sph/solver/statistics.h"

namespace flowskin::sph {

/// The fluid particles at one time, in order of ascending id. All arrays have one entry per particle.
struct FluidState {
  double time = 0;  ///< s
  std::vector<std::uint64_t> ids;
  std::vector<Vec3> positions;   ///< m; inside the domain along periodic axes
  std::vector<Vec3> velocities;  ///< m/s
  std::vector<Vec3>
      rest_positions;  ///< Place of the material in the first frame (m); emitted particles continue the jet backwards.
  std::vector<double> densities;     ///< kg/m^3
  std::vector<std::uint8_t> fluids;  ///< Index into SimulationSetup::fluids; empty: there is only one.
  std::vector<float> viscosities;    ///< Kinematic (m^2/s); empty: the same for all.
};

/// Energies of the fluid (J).
struct Energy {
  double kinetic = 0, potential = 0;
};

class SolverImpl;

/// A running simulation. Results do not depend on the number of OpenMP threads.
class Solver {
 public:
  /// @throws SettingsError where the set-up is impossible.
  explicit Solver(SimulationSetup setup);
  ~Solver();
  Solver(Solver&&) noexcept;
  Solver& operator=(Solver&&) noexcept;

  /// Advances to time `time` (s) exactly, in as many adaptive steps as needed.
  /// @throws BlowUpError where the fluid blows up; the state of the last whole step stays readable.
  void advance_to(double time);
  /// The same, but asks after each step whether to stop early. Going on later, or saving, restoring and going on, gives
  /// the same results as if it had not stopped. @return false where it was stopped
  bool advance_towards(double time, const std::function<bool()>& stop);
  /// One adaptive step of at most `limit` seconds; returns its length.
  double step(double limit = 1e30);

  double time() const;
  std::size_t particle_count() const;
  std::size_t boundary_particle_count() const;
  /// Particles in the order of ascending id.
  FluidState state() const;
  /// Settings with all automatic values (speed of sound, fastest flow, skin) filled in.
  const SolverSettings& settings() const;
  const SolverStatistics& statistics() const;
  /// What of the set-up is likely a slip, such as fluid outside the domain.
  const std::vector<std::string>& warnings() const;
  Energy energy() const;
  Vec3 momentum() const;  ///< kg m/s
  /// Bytes held by the solver's arrays, lists included.
  std::size_t memory_bytes() const;
  /// Boundary particles (m), for pictures and checks.
  std::vector<Vec3> boundary_positions() const;

  /// Saves all that the future depends on but the set-up; the solver goes on as if nothing had been.
  void save(StateWriter& writer) const;
  /// Makes this solver the one that was saved: with the same set-up, all that follows is the same, bit for bit.
  /// max_speed, speed_of_sound and the limits of the time step may be others than they were.
  /// @throws StateError where this is no state of a solver with this set-up; the solver is unusable then.
  void restore(StateReader& reader);

 private:
  std::unique_ptr<SolverImpl> impl_;
};

}  // namespace flowskin::sph
