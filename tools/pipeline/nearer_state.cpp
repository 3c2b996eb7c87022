#include "tools/pipeline/nearer_state.h"

#include <cstddef>
#include <vector>

namespace flowskin::tools {

scenes::ParticleState nearer_state(const scenes::ParticleState& state) {
  if (state.weights.empty()) return state;
  const std::size_t count = state.ids.size(), earlier = state.earlier_count;
  const bool is_earlier = earlier > 0 && state.weights.front() >= 0.5;
  const auto begin = static_cast<std::ptrdiff_t>(is_earlier ? 0 : earlier);
  const auto end = static_cast<std::ptrdiff_t>(is_earlier ? earlier : count);
  const auto part = [&](const auto& values) { return std::vector(values.begin() + begin, values.begin() + end); };
  scenes::ParticleState nearer = state;
  nearer.ids = part(state.ids);
  nearer.positions = part(state.positions);
  nearer.velocities = part(state.velocities);
  nearer.rest_positions = part(state.rest_positions);
  nearer.densities = part(state.densities);
  nearer.weights.clear();
  nearer.earlier_count = 0;
  return nearer;
}

}  // namespace flowskin::tools
