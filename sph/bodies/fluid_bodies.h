// The fluid at the start: shapes filled with a lattice of particles.
#pragma once

#include <vector>

#include "sph/geometry/periodic_box.h"
#include "sph/setup/simulation_setup.h"

namespace flowskin::sph {

struct FluidPoint {
  Vec3 position;  ///< m
  Vec3 velocity;  ///< m/s
  std::size_t body = 0;
};

/// Particles of all bodies, body after body. Each body is filled with a lattice of the spacing that starts half a
/// spacing inside its bounding box, so a block n spacings wide is n particles wide. Left out are points in the body's
/// cuts, points nearer than 0.7 spacings to a particle of an earlier body, and points nearer than half a spacing to a
/// boundary particle. What lies outside a periodic box is wrapped into it.
/// @throws SettingsError where a body has an impossible size, an open mesh, or no particle left, or where its lattice
/// does not fit the period that it fills
std::vector<FluidPoint> fill_bodies(const std::vector<FluidBody>& bodies, double spacing,
                                    const std::vector<Vec3>& boundary_positions, const PeriodicBox& periodic = {});

}  // namespace flowskin::sph
