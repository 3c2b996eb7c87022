// Fluids whose viscosity depends on the rate of shear.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sph/forces/pair_forces.h"
#include "sph/setup/fluid.h"

namespace flowskin::sph {

/// Kinematic viscosity (m^2/s) at a shear rate (1/s), between 0 and the fluid's max_viscosity. Newtonian: its
/// viscosity. Else Herschel and Bulkley's law, regularised [Papanastasiou 1987]:
///   eta = K g^(n - 1) + tau_y (1 - exp(-m g)) / g, with K = rho_0 viscosity and n = 1 where no consistency is given.
double viscosity_at(const Fluid& fluid, double rest_density, double shear_rate);

/// Greatest kinematic viscosity that a fluid can take (m^2/s).
inline double greatest_viscosity(const Fluid& fluid) {
  return fluid.rheology.is_newtonian() ? fluid.viscosity : fluid.rheology.max_viscosity;
}

/// Whether particles need a viscosity each: several fluids, or one whose viscosity depends on the shear rate.
inline bool is_mixture(const std::vector<Fluid>& fluids) {
  return fluids.size() > 1 || (!fluids.empty() && !fluids[0].rheology.is_newtonian());
}

/// Index of the fluid of this name; 0 for the empty name, fluids.size() where there is none.
inline std::size_t index_of(const std::vector<Fluid>& fluids, const std::string& name) {
  std::size_t k = 0;
  while (!name.empty() && k < fluids.size() && fluids[k].name != name) ++k;
  return k;
}

/// The shear rate sqrt(2 D:D) of every particle (1/s), D the deviatoric part of the rate of strain. The velocity
/// gradient is the linear field that fits the velocity differences to fluid and (no-slip) walls best, weighted by the
/// kernel's gradient: exact for linear flows, at walls and free surfaces too.
void find_shear_rates(const PairCoefficients& coefficients, const SolverSettings& settings, const PairData& data,
                      std::span<float> shear_rates);

}  // namespace flowskin::sph
