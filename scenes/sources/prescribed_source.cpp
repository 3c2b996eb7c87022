#include "scenes/sources/prescribed_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "common/errors.h"
#include "scenes/sources/body_particles.h"
#include "scenes/sources/forward_time.h"
#include "scenes/sources/wall_points.h"

namespace flowskin::scenes {

PrescribedSource::PrescribedSource(const Scene& scene)
    : motion_(scene.particles.motion), spacing_(scene.particles.spacing) {
  state_.positions = scene.particles.positions.empty() ? body_particles(scene) : scene.particles.positions;
  const std::size_t count = state_.positions.size();
  if (count == 0) throw InputError(scene.name + ": there are neither bodies nor particles.positions: nothing moves");
  state_.ids.resize(count);
  std::iota(state_.ids.begin(), state_.ids.end(), std::uint64_t{0});
  state_.rest_positions = state_.positions;
  state_.densities.assign(count, 0.0);
  state_.velocities.resize(count);
  state_.walls = sample_walls(scene);
  if (!motion_.has_closed_form()) grid_positions_ = state_.positions;
  advance_to(0);
}

void PrescribedSource::advance_to(double time) {
  require_forward(state_.time, time);
  state_.time = time;
  if (!motion_.has_closed_form()) place_by_integration(time);
  const Vec3 translation = time * motion_.spec().velocity;
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < state_.positions.size(); ++i) {
    if (motion_.has_closed_form()) state_.positions[i] = motion_.local_path(state_.rest_positions[i], time);
    state_.velocities[i] = motion_.local_velocity(state_.positions[i], time) + motion_.spec().velocity;
    state_.positions[i] += translation;
  }
}

void PrescribedSource::place_by_integration(double time) {
  const double step = motion_.integration_step();
  const auto last_step = static_cast<std::uint64_t>(time / step);
  const double rest = time - static_cast<double>(last_step) * step;
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < grid_positions_.size(); ++i) {
    for (std::uint64_t k = grid_step_; k < last_step; ++k)
      grid_positions_[i] = integrated(grid_positions_[i], static_cast<double>(k) * step, step);
    state_.positions[i] = integrated(grid_positions_[i], static_cast<double>(last_step) * step, rest);
  }
  grid_step_ = last_step;
}

Vec3 PrescribedSource::integrated(const Vec3& position, double time, double step) const {
  const double middle = time + 0.5 * step;
  const Vec3 k1 = motion_.local_velocity(position, time);
  const Vec3 k2 = motion_.local_velocity(position + 0.5 * step * k1, middle);
  const Vec3 k3 = motion_.local_velocity(position + 0.5 * step * k2, middle);
  const Vec3 k4 = motion_.local_velocity(position + step * k3, time + step);
  return position + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
}

void PrescribedSource::restore(StateReader& reader) {
  const std::size_t count = state_.ids.size(), grid_count = grid_positions_.size();
  visit(reader);
  check_restored(state_);
  const auto is_finite = [](const Vec3& v) { return v.allFinite(); };
  const bool on_time = grid_count == 0 || static_cast<double>(grid_step_) * motion_.integration_step() <=
                                              state_.time * (1 + 1e-9) + motion_.integration_step();
  if (state_.ids.size() != count || grid_positions_.size() != grid_count || !on_time ||
      !std::all_of(grid_positions_.begin(), grid_positions_.end(), is_finite))
    throw StateError("the saved state is one of other particles");
}

SourceStatistics PrescribedSource::statistics() const {
  SourceStatistics statistics;
  statistics.steps = grid_step_;
  statistics.summary =
      fmt::format("prescribed motion ({}): {} particles, spacing {:.4g} m, paths {}", motion_.spec().type,
                  state_.positions.size(), spacing_,
                  motion_.has_closed_form() ? "in closed form"
                                            : fmt::format("by RK4 with step {:.3g} s", motion_.integration_step()));
  return statistics;
}

}  // namespace flowskin::scenes
