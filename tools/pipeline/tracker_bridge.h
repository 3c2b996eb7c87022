// Between the scenes library and the tracking library, which do not know each other.
#pragma once

#include <type_traits>
#include <utility>

#include "common/state_archive.h"
#include "scenes/settings_in_metres.h"
#include "scenes/sources/particle_source.h"
#include "tools/frame_data.h"
#include "tracking/tracker.h"

namespace flowskin::tools {

/// What the source does not know stays empty.
tracking::Particles to_particles(const scenes::ParticleState& state);

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

}  // namespace flowskin::tools
