// Where the fluid of a set-up is: inside the domain, and near enough for single precision.
#pragma once

#include <string>
#include <vector>

#include "sph/bodies/fluid_bodies.h"
#include "sph/bodies/jet_emitter.h"

namespace flowskin::sph {

/// Whether fluid at p is removed: outside the domain along an axis that has ends.
bool outside_domain(const SolverSettings& settings, const Vec3& p);

/// @return what to warn of: bodies and outlets that lie partly outside the domain
/// @throws SettingsError naming a body or an emitter of which nothing lies inside
std::vector<std::string> check_inside_domain(const SolverSettings& settings, const std::vector<FluidPoint>& points,
                                             std::size_t bodies, const std::vector<JetEmitter>& emitters);

/// Forces are computed in single precision from the middle of everything on.
/// @throws SettingsError where fluid at the start is so far from `origin` that its places are no longer told apart
void check_near_origin(const SolverSettings& settings, const std::vector<FluidPoint>& points, const Vec3& origin);

}  // namespace flowskin::sph
