// The particles of a scene's bodies where no solver is involved.
#pragma once

#include <vector>

#include "scenes/scene.h"

namespace flowskin::scenes {

/// The lattice that the solver would fill the bodies with (m), displaced at random by up to `jitter` spacings along
/// each axis; the same for the same seed.
std::vector<Vec3> body_particles(const Scene& scene);

}  // namespace flowskin::scenes
