// Between the scenes library and the tracking library, which do not know each other.
#pragma once

#include <type_traits>
#include <utility>

#include "common/state_archive.h"
#include "scenes/scene_file.h"
#include "scenes/sources/particle_source.h"
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

/// How far the texture may slip off its particles (spacings); 0: any distance. Where the scene does not say: 1 where an
/// emitter pours, as new surface would go on with the material of its neighbours, and where the motion is prescribed.
/// Else any distance: particles of a simulation mix, and a texture that is held to each of them is noise.
double max_slip_of(const scenes::Scene& scene);

/// Saves or restores a tracker, which is made from its settings before.
template <class Archive>
void visit_tracker(Archive& archive, tracking::Tracker& tracker) {
  if constexpr (std::is_same_v<Archive, StateWriter>) {
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
