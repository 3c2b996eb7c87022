// The fluid and the solver: straight into the settings of sph.
#include "scenes/schema/schema.h"

namespace flowskin::scenes {

namespace {

using sph::range_of;
using sph::SolverSettings;

void add_properties(KeyTable& table, Scene& scene) {
  SolverSettings& solver = scene.solver;
  const Condition one_fluid{"scenes without fluids", [&scene] { return scene.fluids.empty(); }};
  table
      .list("fluids", scene.fluids, add_fluid_keys,
            "Fluids of different viscosity in one scene, instead of fluid.viscosity and fluid.rheology.")
      .selecting();
  table.number("fluid.density", solver.rest_density, range_of(&SolverSettings::rest_density), "kg/m^3",
               "Density at rest.");
  table
      .number("fluid.viscosity", solver.viscosity, range_of(&SolverSettings::viscosity), "m^2/s",
              "Kinematic viscosity: water 1e-6, honey 5e-3.")
      .only_for(one_fluid);
  const std::size_t first = table.keys().size();
  add_rheology_keys(table, "fluid.rheology.", scene.rheology);
  table.restrict_from(first, one_fluid);
  table.number("fluid.surface_tension", solver.surface_tension, range_of(&SolverSettings::surface_tension), "N/m",
               "Surface tension: water 0.072, honey 0.06; 0: none.");
}

void add_viscosity_keys(KeyTable& table, SolverSettings& solver) {
  const Condition not_explicit{"simulation.viscosity_solver \"auto\" or \"implicit\"",
                               [&solver] { return solver.viscosity_solver != sph::ViscositySolver::explicit_steps; }};
  table.choice("simulation.viscosity_form", solver.viscosity_form, sph::kViscosityFormNames,
               "Discrete form of the viscous force; monaghan keeps angular momentum.");
  table
      .choice("simulation.viscosity_solver", solver.viscosity_solver, sph::kViscositySolverNames,
              "explicit: viscosity limits the time step; implicit: a linear system every step instead; auto: implicit "
              "where the viscous limit is below a quarter of the acoustic one.")
      .selecting();
  table
      .number("simulation.viscosity_tolerance", solver.viscosity_tolerance,
              range_of(&SolverSettings::viscosity_tolerance), "",
              "Implicit viscosity: error of the velocities over their change in the step.")
      .only_for(not_explicit);
  table
      .integer("simulation.viscosity_max_iterations", solver.viscosity_max_iterations,
               static_cast<int>(sph::kViscosityIterations.min), static_cast<int>(sph::kViscosityIterations.max), "",
               "Implicit viscosity: iterations after which the run stops with a message.")
      .only_for(not_explicit);
}

void add_density_keys(KeyTable& table, SolverSettings& solver) {
  const Condition by_continuity{"simulation.density_method \"continuity\"",
                                [&solver] { return solver.density_method == sph::DensityMethod::continuity; }};
  table
      .choice("simulation.density_method", solver.density_method, sph::kDensityMethodNames,
              "Density by summation over the neighbours (cannot drift) or from the continuity equation.")
      .selecting();
  table
      .number("simulation.density_diffusion", solver.density_diffusion, range_of(&SolverSettings::density_diffusion),
              "", "Coefficient of the density diffusion; 0: none.")
      .only_for(by_continuity);
  table
      .number("simulation.particle_shifting", solver.particle_shifting, range_of(&SolverSettings::particle_shifting),
              "",
              "Moves particles to even distances, for a constant amount of fluid that fills its space, with suction "
              "and without background pressure; 1 is a good value, 0: none.")
      .only_for(by_continuity);
  table.number(
      "simulation.wall_drag", solver.wall_drag, range_of(&SolverSettings::wall_drag), "",
      "Share of the skin friction of boundary layers thinner than a particle, for fast thin fluid that runs over "
      "dry walls: 1 as boundary-layer theory says, 0 none.");
}

void add_time_step_keys(KeyTable& table, SolverSettings& solver) {
  const Condition with_tension{"fluid.surface_tension > 0", [&solver] { return solver.surface_tension > 0; }};
  table.number("simulation.acoustic_cfl", solver.acoustic_cfl, range_of(&SolverSettings::acoustic_cfl), "",
               "Time step at most this times h / (c + v): h smoothing length, c speed of sound, v speed.");
  table.number("simulation.viscous_cfl", solver.viscous_cfl, range_of(&SolverSettings::viscous_cfl), "",
               "Time step at most this times h^2 / viscosity.");
  table.number("simulation.force_cfl", solver.force_cfl, range_of(&SolverSettings::force_cfl), "",
               "Time step at most this times sqrt(h / a), a the largest acceleration.");
  table
      .number("simulation.capillary_cfl", solver.capillary_cfl, range_of(&SolverSettings::capillary_cfl), "",
              "Time step at most this times sqrt(density h^3 / (2 pi surface tension)).")
      .only_for(with_tension);
  table.number("simulation.max_time_step", solver.max_time_step, range_of(&SolverSettings::max_time_step), "s",
               "Largest time step.");
  table.number("simulation.skin", solver.skin, range_of(&SolverSettings::skin), "spacings",
               "Skin of the neighbour lists; 0: the recommended one.");
}

}  // namespace

void add_solver_keys(KeyTable& table, Scene& scene) {
  SolverSettings& solver = scene.solver;
  const std::size_t first = table.keys().size();
  add_properties(table, scene);
  table.vector("simulation.gravity", solver.gravity, "m/s^2", "Acceleration of gravity.", sph::kGreatestGravity);
  table.choice("simulation.kernel", solver.kernel, sph::kKernelNames, "Smoothing kernel.");
  table.number("simulation.support_radius", solver.support_radius, range_of(&SolverSettings::support_radius),
               "spacings", "Support radius of the kernel; 2 gives about 30 neighbours.");
  table.number("simulation.max_speed", solver.max_speed, range_of(&SolverSettings::max_speed), "m/s",
               "Fastest flow expected; 0: from heights, gravity and initial velocities.");
  table.number("simulation.speed_of_sound", solver.speed_of_sound, range_of(&SolverSettings::speed_of_sound), "m/s",
               "Speed of sound; 0: ten times the fastest flow expected.");
  table.number(
      "simulation.background_pressure", solver.background_pressure, range_of(&SolverSettings::background_pressure),
      "Pa",
      "Added to the pressure everywhere, for fluid that fills its space: periodic boxes, pipes. 0: there are free "
      "surfaces; they do not pull.");
  table.number("simulation.xsph", solver.xsph, range_of(&SolverSettings::xsph), "",
               "Share of XSPH smoothing in the velocity that moves particles.");
  add_viscosity_keys(table, solver);
  add_density_keys(table, solver);
  add_time_step_keys(table, solver);
  table.vector(
      "simulation.domain.min", solver.domain.min, "m",
      "Lower corner of the domain: particles that leave it are removed. No limit along axes where both corners "
      "are the same.");
  table.vector("simulation.domain.max", solver.domain.max, "m", "Upper corner of the domain.");
  table.axes("simulation.periodic", solver.periodic,
             "Axes along which the domain is periodic: what leaves it comes back through the opposite face. Needs "
             "tracking.enabled false.");
  table.restrict_from(first, {"particles.source \"simulation\"",
                              [&scene] { return scene.particles.source == ParticlesSpec::Source::simulation; }});
}

}  // namespace flowskin::scenes
