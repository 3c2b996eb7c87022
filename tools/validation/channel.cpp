#include "tools/validation/channel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/validation/flow_setup.h"

namespace flowskin::tools {
namespace {

using sph::Vec3;

constexpr double kChannelWidth = 1e-3, kChannelViscosity = 1e-6,
                 kChannelSpeed = 1.25e-5;                         // m, m^2/s, m/s, all as in [MFZ97]
constexpr double kChannelTimes[] = {0.0225, 0.045, 0.1125, 1.0};  // L^2 / nu

sph::SimulationSetup channel(const ChannelFlow& flow, int across) {
  const double spacing = kChannelWidth / across, length = 6 * spacing;
  sph::SimulationSetup setup =
      flow_setup(spacing, kChannelViscosity,
                 {flow.force * kChannelViscosity * kChannelSpeed / (kChannelWidth * kChannelWidth), 0, 0});
  setup.settings.max_speed = kChannelSpeed;
  // Steps of the explicit scheme, so that the error is that of space alone.
  setup.settings.viscosity_solver = sph::ViscositySolver::explicit_steps;
  add_endless_floor(length, setup);
  setup.bodies.push_back(block_body({0, 0, 0}, {length, kChannelWidth, length}));
  setup.boundaries.push_back(plane_wall({0, kChannelWidth, 0}, {length, 0, 0}, {0, 0, length}, 0));
  setup.boundaries.back().surface_velocity = {flow.wall_speed * kChannelSpeed, 0, 0};
  return setup;
}

// Speeds of all particles, computed and reference, in units of V0.
struct Profile {
  std::vector<double> y, computed, reference;
};

Profile profile(const ChannelFlow& flow, const sph::Solver& solver, double time) {
  const sph::FluidState state = solver.state();
  std::vector<std::size_t> order(state.ids.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return state.positions[a].y() < state.positions[b].y(); });
  Profile result;
  for (const std::size_t i : order) {
    const double y = state.positions[i].y() / kChannelWidth;
    result.y.push_back(y);
    result.computed.push_back(state.velocities[i].x() / kChannelSpeed);
    result.reference.push_back(flow.reference(y, time));
  }
  return result;
}

}  // namespace

ValidationResult run_channel(const ChannelFlow& flow, double resolution) {
  ValidationResult result;
  result.data.columns = {"particles_across", "time_nu_per_l2", "y_per_l", "speed_per_v0", "reference_per_v0"};
  Plot speeds = line_plot(flow.title, "y / L", "u / V0", {});
  Plot errors = line_plot("Convergence", "particles across", "relative L2 error", {});
  errors.log_x = errors.log_y = true;
  errors.series.resize(std::size(kChannelTimes));
  std::vector<double> log_spacing, log_error;
  const int counts[] = {10, 20, 40};
  for (const int count : counts) {
    const int across = static_cast<int>(std::lround(count * resolution));
    sph::Solver solver(channel(flow, across));
    double worst = 0;
    for (std::size_t k = 0; k < std::size(kChannelTimes); ++k) {
      solver.advance_to(kChannelTimes[k] * kChannelWidth * kChannelWidth / kChannelViscosity);
      const Profile p = profile(flow, solver, kChannelTimes[k]);
      const double error = relative_l2(p.computed, p.reference);
      worst = std::max(worst, error);
      errors.series[k].name = fmt::format("t = {} L²/ν", kChannelTimes[k]);
      errors.series[k].x.push_back(across);
      errors.series[k].y.push_back(error);
      for (std::size_t i = 0; i < p.y.size(); ++i)
        result.data.add({across, kChannelTimes[k], p.y[i], p.computed[i], p.reference[i]});
      if (count != counts[2]) continue;
      result.figures.push_back(
          at_most(fmt::format("relative L2 error of the speed; {} across; t = {} L^2/nu", across, kChannelTimes[k]),
                  error, 0.02));
      speeds.series.push_back({k == 0 ? "series" : "", p.y, p.reference, 0});
      speeds.series.push_back(
          {fmt::format("computed, t = {} L²/ν", kChannelTimes[k]), p.y, p.computed, static_cast<int>(k) + 1});
    }
    log_spacing.push_back(-std::log(across));
    log_error.push_back(std::log(worst));
  }
  result.figures.push_back(
      at_least("order of convergence of the worst of these errors", fitted_slope(log_spacing, log_error), 1.5));
  result.plots.plots = {speeds, errors};
  return result;
}

}  // namespace flowskin::tools
