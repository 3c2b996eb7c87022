#include "scenes/sources/particle_source.h"

#include <algorithm>
#include <cmath>

namespace flowskin::scenes {

void check_restored(const ParticleState& state) {
  const std::size_t count = state.ids.size();
  const auto is_finite = [](const Vec3& v) { return v.allFinite(); };
  const auto is_whole = [&](const std::vector<Vec3>& vectors) {
    return vectors.size() == count && std::all_of(vectors.begin(), vectors.end(), is_finite);
  };
  const auto fits = [&](const auto& values) { return values.size() == count || values.empty(); };
  const bool sound = std::isfinite(state.time) && is_whole(state.positions) && is_whole(state.velocities) &&
                     is_whole(state.rest_positions) && state.densities.size() == count && fits(state.weights) &&
                     fits(state.fluids) && fits(state.viscosities) && state.earlier_count <= count;
  if (!sound) throw StateError("the saved particles contradict themselves");
}

}  // namespace flowskin::scenes
