// From a scene to its particle source.
#pragma once

#include "scenes/scene.h"
#include "scenes/sources/particle_source.h"

namespace flowskin::scenes {

/// The scene's particle source, at time 0.
/// @throws InputError, sph::SettingsError where the scene cannot be started.
std::unique_ptr<ParticleSource> make_source(const Scene& scene);

}  // namespace flowskin::scenes
