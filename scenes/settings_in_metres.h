// From a scene, whose lengths count in spacings, to the settings that the tracker takes.
#pragma once

#include <string>

#include "scenes/scene.h"
#include "scenes/sources/particle_source.h"

namespace flowskin::scenes {

/// The scene's settings of the tracker with all lengths in metres: the only place where they are converted.
tracking::TrackerSettings settings_in_metres(const Scene& scene);

/// How far the texture may slip off its particles (spacings); 0: any distance. Where the scene does not say: 1 where an
/// emitter pours, as new surface would go on with the material of its neighbours, and where the motion is prescribed.
/// Else any distance: particles of a simulation mix, and a texture that is held to each of them is noise.
double max_slip_of(const Scene& scene);

/// The method of that name, or for automatic_velocity the best one for these particles.
std::string velocity_method_for(const std::string& name, const ParticleState& state);

}  // namespace flowskin::scenes
