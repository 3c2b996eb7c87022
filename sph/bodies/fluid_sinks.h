// Regions that remove the fluid which flows into them.
#pragma once

#include "sph/setup/simulation_setup.h"

namespace flowskin::sph {

/// Whether a point lies in any of the sinks that are open at `time`.
bool in_open_sink(const std::vector<Sink>& sinks, const Vec3& p, double time);

/// @throws SettingsError where the sink is impossible; `name` says which one it is
void check_sink(const Sink& sink, const std::string& name);

}  // namespace flowskin::sph
