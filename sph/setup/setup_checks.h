// Checks of a set-up.
#pragma once

#include "sph/setup/simulation_setup.h"

namespace flowskin::sph {

/// @throws SettingsError with the name of the first impossible setting, its value and what was expected
void check_setup(const SimulationSetup& setup);

}  // namespace flowskin::sph
