// Vortices in a periodic box die out as exp(-2 nu k^2 t) [Taylor and Green 1937, two-dimensional].
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "tools/validation/flow_setup.h"
#include "tools/validation/validation_case.h"

namespace flowskin::tools {
namespace taylor_green {

using sph::Vec3;

constexpr double kBox = 1, kTopSpeed = 1;  // m, m/s
constexpr double kWaveNumber = 2 * std::numbers::pi / kBox;
// In spacings. With the default 2 the viscosity of a lattice that is stretched, not sheared, is a third too high.
constexpr double kSupport = 3.5;

sph::SimulationSetup vortices(int across, double reynolds) {
  const double spacing = kBox / across, thickness = 2 * kSupport * spacing;
  sph::SimulationSetup setup = flow_setup(spacing, kTopSpeed * kBox / reynolds, Vec3::Zero());
  setup.settings.max_speed = kTopSpeed;
  setup.settings.support_radius = kSupport;
  setup.settings.density_method = sph::DensityMethod::continuity;
  setup.settings.particle_shifting = 1;
  setup.settings.domain = {{0, 0, 0}, {kBox, kBox, thickness}};
  setup.settings.periodic = {true, true, true};
  // One body per column of the lattice, as each has its own velocity.
  for (int i = 0; i < across; ++i) {
    for (int j = 0; j < across; ++j) {
      const Vec3 corner(i * spacing, j * spacing, 0);
      const double x = kWaveNumber * (i + 0.5) * spacing, y = kWaveNumber * (j + 0.5) * spacing;
      const Vec3 velocity(-std::cos(x) * std::sin(y), std::sin(x) * std::cos(y), 0);
      setup.bodies.push_back(block_body(corner, corner + Vec3(spacing, spacing, thickness), kTopSpeed * velocity));
    }
  }
  return setup;
}

// Share of the vortices in the flow: the projection of the velocities onto their field.
double amplitude(const sph::FluidState& state) {
  double sum = 0, norm = 0;
  for (std::size_t i = 0; i < state.ids.size(); ++i) {
    const Vec3& p = state.positions[i];
    const Vec3 field(-std::cos(kWaveNumber * p.x()) * std::sin(kWaveNumber * p.y()),
                     std::sin(kWaveNumber * p.x()) * std::cos(kWaveNumber * p.y()), 0);
    sum += field.dot(state.velocities[i]);
    norm += field.squaredNorm();
  }
  return sum / norm / kTopSpeed;
}

ValidationResult run(double resolution) {
  ValidationResult result;
  result.data.columns = {"reynolds", "time_s", "amplitude", "kinetic_energy_per_start", "reference_amplitude"};
  Plot plot = line_plot("Taylor–Green vortices", "2 ν k² t", "share of the start", {});
  plot.log_y = true;
  Series reference{"exp(−2 ν k² t)", {}, {}};
  for (const double reynolds : {10.0, 100.0}) {
    sph::Solver solver(vortices(static_cast<int>(std::lround(40 * resolution)), reynolds));
    const double rate = 2 * solver.settings().viscosity * kWaveNumber * kWaveNumber;
    const double start_energy = solver.energy().kinetic;
    Series vortex{fmt::format("vortices, Re {}", reynolds), {}, {}};
    std::vector<double> time, log_energy;
    for (int n = 0; n <= 30; ++n) {
      const double t = n / 30.0 * 1.5 / rate;  // until the speed has fallen to a fifth
      solver.advance_to(t);
      const double a = amplitude(solver.state()), energy = solver.energy().kinetic / start_energy;
      vortex.x.push_back(rate * t), vortex.y.push_back(a);
      time.push_back(t), log_energy.push_back(std::log(energy));
      result.data.add({reynolds, t, a, energy, std::exp(-rate * t)});
      if (reynolds < 50) reference.x.push_back(rate * t), reference.y.push_back(std::exp(-rate * t));
    }
    plot.series.push_back(vortex);
    std::vector<double> log_amplitude;
    for (const double a : vortex.y) log_amplitude.push_back(std::log(a));
    result.figures.push_back(near_to(fmt::format("decay rate of the vortices over the theory's; Re {}", reynolds),
                                     -fitted_slope(time, log_amplitude) / rate, 1, 0.05));
    result.figures.push_back(near_to(fmt::format("decay rate of the kinetic energy over the theory's; Re {}", reynolds),
                                     -fitted_slope(time, log_energy) / (2 * rate), 1, 0.05));
  }
  plot.series.push_back(reference);
  result.plots.plots = {plot};
  return result;
}

}  // namespace taylor_green

ValidationCase taylor_green_case() {
  return {"taylor_green", "vortices in a periodic box die out at the rate of the theory, Re 10 and 100", false,
          taylor_green::run};
}

}  // namespace flowskin::tools
