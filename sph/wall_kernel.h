// How walls act on the fluid: a kernel of their own, shorter than that of the fluid.
#pragma once

#include "sph/solver.h"

namespace flowskin::sph {

/// Boundary particles are one layer on the surface itself. With the fluid's kernel such a layer would hold the fluid a
/// whole spacing away, and its push would fade as a particle comes close. So walls have a shorter kernel, chosen such
/// that a lattice of fluid half a spacing above a plane is exactly in equilibrium with it. The volumes V_b = 1 / sum W
/// of [AIA*12, Eq. 4] with this kernel make a particle *on* a wall see a compression of at least 1: a high barrier.
struct WallKernel {
  double support = 0;         ///< R_b (m)
  double sample_spacing = 0;  ///< Distance of boundary particles (m), half of R_b.
  /// Factor of the viscous force of walls, by which a layer of fluid that slides half a spacing above a plane at speed
  /// u feels the shear stress rho nu u / (spacing / 2).
  double friction_factor = 1;
};

/// @param settings spacing, support_radius, kernel and viscosity_form are used
WallKernel make_wall_kernel(const SolverSettings& settings);

/// Sum of spacing^3 W over a lattice of the spacing: 1 for an ideal kernel, 1.03 for the Wendland kernel with R = 2
/// spacings.
double lattice_kernel_sum(const SolverSettings& settings);

/// Factor that makes the discrete Laplacian of the viscous force exact for a quadratic shear flow on the lattice.
double lattice_viscosity_factor(const SolverSettings& settings);

}  // namespace flowskin::sph
