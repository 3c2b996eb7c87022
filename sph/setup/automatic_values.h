// The values that settings leave to the solver.
#pragma once

#include "sph/setup/simulation_setup.h"

namespace flowskin::sph {

/// Fills in max_speed, speed_of_sound and skin where they are 0, the greatest viscosity of all fluids, and the
/// viscosity solver where it is automatic. The fastest flow expected is that of fluid which falls, without friction,
/// from the highest fluid or emitter to the lowest point of the walls (without walls: of the fluid): sqrt(v_0^2 + 2 g
/// H).
/// @param fluid_box,fluid_speed box (m) and greatest speed (m/s) of the fluid bodies' particles
SolverSettings with_automatic_values(const SimulationSetup& setup, const Box& fluid_box, double fluid_speed);

/// Longest step at which the explicit viscous force is stable (s); infinite without viscosity.
double viscous_step_limit(const SolverSettings& settings, double viscosity);

}  // namespace flowskin::sph
