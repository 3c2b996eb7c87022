// Between the scenes library and the tracking library, which do not know each other.
#pragma once

#include "scenes/scene_file.h"
#include "scenes/sources/particle_source.h"
#include "tracking/tracker.h"

namespace flowskin::tools {

/// What the source does not know stays empty.
tracking::Particles to_particles(const scenes::ParticleState& state);

/// Lengths that the scene gives in spacings become metres.
tracking::TrackerSettings tracker_settings(const scenes::Scene& scene);

/// The names that scene files may use for velocity methods.
scenes::SceneVocabulary scene_vocabulary();

}  // namespace flowskin::tools
