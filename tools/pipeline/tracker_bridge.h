// Between the scenes library and the tracking library, which do not know each other.
#pragma once

#include <type_traits>
#include <utility>

#include "scenes/scene_file.h"
#include "scenes/sources/particle_source.h"
#include "sph/state_archive.h"
#include "tools/frame_data.h"
#include "tracking/tracker.h"

namespace flowskin::tools {

/// What the source does not know stays empty.
tracking::Particles to_particles(const scenes::ParticleState& state);

/// What a scene says for the best velocity method that its particles allow.
inline constexpr const char* kAutomaticVelocity = "auto";

/// The method of that name, or the best one for these particles.
std::string velocity_method_for(const std::string& name, const scenes::ParticleState& state);

/// Lengths that the scene gives in spacings become metres.
tracking::TrackerSettings tracker_settings(const scenes::Scene& scene);

/// Saves or restores a tracker, which is made from its settings before.
template <class Archive>
void visit_tracker(Archive& archive, tracking::Tracker& tracker) {
  if constexpr (std::is_same_v<Archive, sph::StateWriter>) {
    archive(tracker.state());
  } else {
    tracking::TrackerState state;
    archive(state);
    tracker.restore(std::move(state));
  }
}

/// How well the field determines the velocity of each vertex: in the weak and the strong direction.
std::vector<Vec2f> confidence_attribute(const tracking::Tracker& tracker);

/// The names that scene files may use for velocity methods.
scenes::SceneVocabulary scene_vocabulary();

}  // namespace flowskin::tools
