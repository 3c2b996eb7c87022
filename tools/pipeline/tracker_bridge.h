// Between the scenes library and the tracking library, which do not know each other.
#pragma once

#include "scenes/scene_file.h"
#include "scenes/sources/particle_source.h"
#include "tools/frame_data.h"
#include "tracking/tracker.h"

namespace flowskin::tools {

tracking::Particles to_particles(const scenes::ParticleState& state);

/// Lengths that the scene gives in spacings become metres.
tracking::TrackerSettings tracker_settings(const scenes::Scene& scene);

/// How well the field determines the velocity of each vertex: in the weak and the strong direction.
std::vector<Vec2f> confidence_attribute(const tracking::Tracker& tracker);

/// The names that scene files may use for velocity methods.
scenes::SceneVocabulary scene_vocabulary();

}  // namespace flowskin::tools
