#include "scenes/sources/simulation_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/errors.h"
#include "scenes/sources/forward_time.h"
#include "scenes/sources/wall_points.h"

namespace flowskin::scenes {
namespace {

sph::SimulationSetup setup_of(const Scene& scene) {
  sph::SimulationSetup setup;
  setup.settings = scene.solver;
  setup.settings.spacing = scene.particles.spacing;
  setup.fluids = scene.fluids;
  if (setup.fluids.empty() && !scene.rheology.is_newtonian()) {
    setup.fluids.push_back({"the fluid", scene.solver.viscosity, scene.rheology});
  }
  for (const BodySpec& body : scene.bodies) setup.bodies.push_back(body.body);
  for (const EmitterSpec& emitter : scene.emitters) setup.emitters.push_back(emitter.emitter);
  for (const SinkSpec& sink : scene.sinks) setup.sinks.push_back(sink.sink);
  for (const BoundarySpec& boundary : scene.boundaries) {
    setup.boundaries.push_back(boundary.boundary);
    setup.boundaries.back().name = boundary.mesh.file;
  }
  return setup;
}

/// What blows up before its first step is wrong in the scene.
sph::Solver solver_of(const Scene& scene) {
  try {
    return sph::Solver(setup_of(scene));
  } catch (const sph::BlowUpError& error) {
    throw InputError(error.what());
  }
}

std::string viscosity_solver(const sph::SolverSettings& settings, const sph::SolverStatistics& statistics) {
  if (settings.viscosity_solver != sph::ViscositySolver::implicit) return "explicit";
  const auto steps = static_cast<double>(std::max<std::uint64_t>(1, statistics.steps));
  return fmt::format("implicit ({:.1f} iterations per step, tolerance {:g}: velocities to {:.1e} m/s in the last step)",
                     static_cast<double>(statistics.viscosity_iterations) / steps, settings.viscosity_tolerance,
                     statistics.viscosity_tolerance);
}

}  // namespace

SimulationSource::SimulationSource(const Scene& scene) : solver_(solver_of(scene)), walls_(sample_walls(scene)) {
  take_state();
}

void SimulationSource::advance_to(double time) {
  advance_towards(time, [] { return false; });
}

bool SimulationSource::advance_towards(double time, const std::function<bool()>& stop) {
  require_forward(state_.time, time);
  if (!solver_.advance_towards(time, stop)) return false;
  take_state();
  return true;
}

void SimulationSource::restore(StateReader& reader) {
  solver_.restore(reader);
  take_state();
}

void SimulationSource::take_state() {
  sph::FluidState fluid = solver_.state();
  state_ = {fluid.time,
            std::move(fluid.ids),
            std::move(fluid.positions),
            std::move(fluid.velocities),
            std::move(fluid.rest_positions),
            std::move(fluid.densities)};
  state_.fluids = std::move(fluid.fluids);
  state_.viscosities = std::move(fluid.viscosities);
  state_.walls = walls_;
}

SourceStatistics SimulationSource::statistics() const {
  const sph::SolverSettings& settings = solver_.settings();
  const sph::SolverStatistics& solver = solver_.statistics();
  const sph::Energy energy = solver_.energy();
  SourceStatistics statistics;
  statistics.steps = solver.steps;
  statistics.left_domain = solver.left_domain;
  statistics.emitted = solver.emitted;
  statistics.drained = solver.drained;
  statistics.wall_crossings = solver.wall_crossings;
  statistics.kept_out_of_gaps = solver.kept_out_of_gaps;
  statistics.kinetic_energy = energy.kinetic;
  statistics.potential_energy = energy.potential;
  for (const double density : state_.densities) {
    const double error = std::abs(density / settings.rest_density - 1);
    statistics.mean_density_error += error / static_cast<double>(state_.densities.size());
    statistics.max_density_error = std::max(statistics.max_density_error, error);
  }
  statistics.last_time_step = solver.last_step.step;
  statistics.seconds = {{"neighbours", solver.seconds_neighbors}, {"forces", solver.seconds_forces}};
  if (solver.seconds_viscosity > 0) statistics.seconds.emplace_back("viscosity", solver.seconds_viscosity);
  statistics.seconds.emplace_back("integration", solver.seconds_integration);
  statistics.summary = fmt::format(
      "simulation: {} fluid and {} wall particles, spacing {:.4g} m, support radius {:.4g} m, speed of sound {:.4g} "
      "m/s "
      "(fastest flow expected {:.4g} m/s), viscosity {:.4g} m^2/s, {}; steps limited by "
      "acoustic/viscous/force/capillary: "
      "{}/{}/{}/{}; "
      "{:.1f} MB",
      solver_.particle_count(), solver_.boundary_particle_count(), settings.spacing,
      settings.support_radius * settings.spacing, settings.speed_of_sound, settings.max_speed, settings.viscosity,
      viscosity_solver(settings, solver), solver.steps_limited_by_acoustic, solver.steps_limited_by_viscous,
      solver.steps_limited_by_force, solver.steps_limited_by_capillary,
      static_cast<double>(solver_.memory_bytes()) / 1e6);
  if (solver.squeezed_through > 0) {
    statistics.summary +=
        fmt::format("; {} particles passed moving walls that left them no room", solver.squeezed_through);
  }
  return statistics;
}

}  // namespace flowskin::scenes
