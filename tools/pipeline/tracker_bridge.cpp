#include "tools/pipeline/tracker_bridge.h"

namespace flowskin::tools {

tracking::Particles to_particles(const scenes::ParticleState& state) {
  tracking::Particles particles;
  particles.time = state.time;
  particles.ids = state.ids;
  particles.positions = state.positions;
  if (state.has_velocities) particles.velocities = state.velocities;
  if (state.has_material) particles.rest_positions = state.rest_positions;
  particles.weights = state.weights;
  particles.has_lasting_ids = state.has_lasting_ids;
  particles.walls = state.walls;
  return particles;
}

std::vector<Vec2f> confidence_attribute(const tracking::Tracker& tracker) {
  std::vector<Vec2f> attribute;
  for (const tracking::Confidence& confidence : tracker.confidence())
    attribute.emplace_back(float(confidence.weak), float(confidence.strong));
  return attribute;
}

}  // namespace flowskin::tools
