// A drop that is let go as an ellipsoid oscillates at Rayleigh's frequency.
#include <fmt/format.h>

#include "tools/validation/drop_measures.h"
#include "tools/validation/validation_case.h"

namespace flowskin::tools {
namespace oscillating_drop {

constexpr double kViscosity = 5e-4, kStretch = 1.15, kPeriods = 2.5;

ValidationResult run(double resolution) {
  ValidationResult result;
  result.data.columns = {"spacings_per_radius", "time_over_period", "elongation", "rayleigh_and_lamb"};
  Plot plot = line_plot("Oscillating drop", "time / Rayleigh's period", "elongation", {});
  for (const double spacings : {5.0, 8.0}) {
    sph::Solver solver(DropSetup::ellipsoid(spacings * resolution, kViscosity, kStretch));
    const double frequency = rayleigh_frequency(solver.particle_count(), solver.settings().spacing);
    const double decay = 5 * kViscosity / (DropSetup::kRadius * DropSetup::kRadius);
    const double start = elongation(solver.state());
    Series seen{fmt::format("R = {:.3g} spacings", spacings * resolution), {}, {}};
    Series theory{"Rayleigh's frequency, Lamb's decay", {}, {}};
    std::vector<double> times, values;
    for (int k = 0; k <= 40 * kPeriods; ++k) {
      const double t = k * 2 * M_PI / frequency / 40;
      solver.advance_to(t);
      const double value = elongation(solver.state());
      const double expected =
          start * std::exp(-decay * t) * std::cos(std::sqrt(frequency * frequency - decay * decay) * t);
      // The first fifth of a period, in which the lattice of the start finds its order, is not looked at.
      if (k >= 8) {
        times.push_back(t);
        values.push_back(value);
      }
      seen.x.push_back(k / 40.0);
      seen.y.push_back(value);
      theory.x.push_back(k / 40.0);
      theory.y.push_back(expected);
      result.data.add({spacings * resolution, k / 40.0, value, expected});
    }
    const Oscillation oscillation = fit_oscillation(times, values, frequency);
    result.figures.push_back(
        near_to(fmt::format("frequency over Rayleigh's, R = {:.3g} spacings", spacings * resolution),
                oscillation.frequency / frequency, 1, 0.1));
    if (plot.series.empty()) plot.series.push_back(theory);
    plot.series.push_back(seen);
  }
  plot.note = "drop of 0.1 m radius, 1000 kg/m³, 1 N/m, viscosity 5e-4 m²/s, let go 15 % longer than round";
  result.plots.plots = {plot};
  return result;
}

}  // namespace oscillating_drop

ValidationCase oscillating_drop_case() {
  return {"oscillating_drop", "drop under surface tension, two spacings: Rayleigh's frequency of mode 2", false,
          oscillating_drop::run};
}

}  // namespace flowskin::tools
