// How walls act on the fluid: a kernel of their own, shorter than that of the fluid.
#pragma once

#include "sph/setup/settings.h"

namespace flowskin::sph {

/// Boundary particles are one layer on the surface itself. With the fluid's kernel such a layer would hold the fluid a
/// whole spacing away, and its push would fade as a particle comes close. So walls have a shorter kernel, and the
/// volumes V_b = 1 / sum W of [AIA*12, Eq. 4] a factor, chosen such that a lattice of fluid half a spacing above a
/// plane has the density it has inside, and feels the force of the half space that is missing: it is in equilibrium
/// under any pressure.
struct WallKernel {
  double support = 0;         ///< R_b (m), about one spacing
  double sample_spacing = 0;  ///< Distance of boundary particles (m), 0.4 R_b.
  double volume_factor = 1;   ///< Factor of V_b.
  double compression = 0;     ///< What a plane adds to the kernel sum, over that of the lattice, half a spacing above.
  double area_factor = 0;     ///< Area of a boundary particle in a plane over its volume, factor included (1/m).
  /// Factor of the viscous force of walls, by which a layer of fluid that slides half a spacing above a plane at speed
  /// u feels the shear stress rho nu u / (spacing / 2).
  double friction_factor = 1;
};

/// @param settings spacing, support_radius, kernel and viscosity_form are used
WallKernel make_wall_kernel(const SolverSettings& settings);

/// Sum of spacing^3 W over a lattice of the spacing: 1 for an ideal kernel, 1.03 for the Wendland kernel with R = 2
/// spacings.
double lattice_kernel_sum(const SolverSettings& settings);

/// Factor of the pressure forces, by which the stress in a compressed lattice is the pressure of the equation of state.
/// Without it the stress is sum V r |dW/dr| / (3 sum V W) times as large: 0.95 for the Wendland kernel with R = 2
/// spacings.
double lattice_pressure_factor(const SolverSettings& settings);

/// Factor of the viscous weight of pairs (viscous_pairs.h) that makes the force exact for a quadratic shear flow on the
/// lattice, at a viscosity of 1 m^2/s (1/m^4).
double lattice_viscosity_scale(const SolverSettings& settings);

}  // namespace flowskin::sph
