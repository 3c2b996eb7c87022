// Of two blended states, the one that is written and drawn.
#pragma once

#include "scenes/sources/particle_source.h"

namespace flowskin::tools {

/// The particles of the nearer one of two blended states; other states as they are.
scenes::ParticleState nearer_state(const scenes::ParticleState& state);

}  // namespace flowskin::tools
