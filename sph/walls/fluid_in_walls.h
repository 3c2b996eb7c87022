// Fluid that would begin inside closed walls, where it could never come out.
#pragma once

#include <string>
#include <vector>

#include "sph/bodies/fluid_bodies.h"
#include "sph/bodies/jet_emitter.h"
#include "sph/geometry/periodic_box.h"

namespace flowskin::sph {

/// Leaves out the fluid particles, and those of the emitters' layers, that would begin inside the closed parts of walls
/// (ClosedParts) that are not hollow, or of their periodic images. Walls count where they are at the start; for an
/// emitter, where they are when it begins to pour.
/// @return what to warn of: how many of each body and emitter, and by which wall
/// @throws SettingsError where no fluid would be left
std::vector<std::string> leave_out_fluid_in_walls(const std::vector<Boundary>& walls, std::size_t bodies,
                                                  const PeriodicBox& periodic, std::vector<FluidPoint>& points,
                                                  std::vector<JetEmitter>& emitters);

}  // namespace flowskin::sph
