// What a solver counts and measures on its way.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "common/named_value.h"
#include "common/state_archive.h"

namespace flowskin::sph {

/// What kept a time step from being longer: a condition of stability, max_time_step, or the time asked for.
enum class TimeStepLimit { none, acoustic, viscous, force, capillary, setting, output };
/// Words of the saved state.
inline constexpr std::array<NamedValue<TimeStepLimit>, 7> kTimeStepLimitNames{{{"", TimeStepLimit::none},
                                                                               {"acoustic", TimeStepLimit::acoustic},
                                                                               {"viscous", TimeStepLimit::viscous},
                                                                               {"force", TimeStepLimit::force},
                                                                               {"capillary", TimeStepLimit::capillary},
                                                                               {"setting", TimeStepLimit::setting},
                                                                               {"output", TimeStepLimit::output}}};

/// Which limit set the time step, and all of them (s).
struct TimeStepReport {
  double step = 0, acoustic = 0, viscous = 0, force = 0, capillary = 0;
  TimeStepLimit limited_by = TimeStepLimit::none;

  template <class Archive>
  void visit(Archive& archive) {
    std::string word(name_of(kTimeStepLimitNames, limited_by));
    archive(step, acoustic, viscous, force, capillary, word);
    const std::optional<TimeStepLimit> limit = value_named(kTimeStepLimitNames, word);
    if (!limit) throw StateError("the saved state has a limit of the time step that there is not: " + word);
    limited_by = *limit;
  }
};

/// Counters since the start, and seconds spent per stage.
struct SolverStatistics {
  std::uint64_t steps = 0;
  std::uint64_t list_rebuilds = 0;
  std::uint64_t left_domain = 0;       ///< Particles removed because they left the domain.
  std::uint64_t wall_crossings = 0;    ///< Particle paths that would have passed a wall and were put back.
  std::uint64_t kept_out_of_gaps = 0;  ///< Particle paths that led into gaps narrower than the spacing.
  std::uint64_t squeezed_through = 0;  ///< Particles that moving walls left no room: they passed one.
  std::uint64_t emitted = 0;
  std::uint64_t not_emitted = 0;  ///< Particles that emitters left out because their places were taken.
  std::uint64_t drained = 0;      ///< Particles removed by sinks.
  std::uint64_t steps_limited_by_acoustic = 0, steps_limited_by_viscous = 0, steps_limited_by_force = 0;
  std::uint64_t viscosity_iterations = 0;  ///< Of the implicit viscosity, in all steps.
  double viscosity_tolerance = 0;          ///< Residual that the last implicit step asked for (m/s, root mean square).
  std::uint64_t steps_limited_by_capillary = 0;
  TimeStepReport last_step;
  double seconds_neighbors = 0, seconds_forces = 0, seconds_viscosity = 0, seconds_integration = 0;

  /// Counts a step that last_step describes.
  void count_step() {
    ++steps;
    steps_limited_by_acoustic += last_step.limited_by == TimeStepLimit::acoustic;
    steps_limited_by_viscous += last_step.limited_by == TimeStepLimit::viscous;
    steps_limited_by_force += last_step.limited_by == TimeStepLimit::force;
    steps_limited_by_capillary += last_step.limited_by == TimeStepLimit::capillary;
  }

  template <class Archive>
  void visit(Archive& archive) {
    archive(steps, list_rebuilds, left_domain, wall_crossings, squeezed_through, emitted, not_emitted, drained);
    archive(steps_limited_by_acoustic, steps_limited_by_viscous, steps_limited_by_force, steps_limited_by_capillary);
    archive(kept_out_of_gaps, last_step, viscosity_iterations, viscosity_tolerance);
    archive(seconds_neighbors, seconds_forces, seconds_viscosity, seconds_integration);
  }
};

}  // namespace flowskin::sph
