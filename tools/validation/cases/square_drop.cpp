// A cube of fluid becomes a ball under surface tension; at rest its pressure is Laplace's.
#include <fmt/format.h>

#include "tools/validation/drop_measures.h"
#include "tools/validation/validation_case.h"

namespace flowskin::tools {
namespace square_drop {

ValidationResult run(double resolution) {
  ValidationResult result;
  result.data.columns = {"spacings_per_radius", "time_s", "asphericity", "gyration_radius_over_ball",
                         "core_pressure_over_laplace"};
  Plot shape = line_plot("Square drop", "time (s)", "asphericity (0: round)", {});
  Plot pressure = line_plot("Pressure inside", "time (s)", "pressure / (2 γ / R)", {});
  for (const double spacings : {5.0, 7.0}) {
    sph::Solver solver(DropSetup::cube(spacings * resolution, 2e-3));
    const double spacing = solver.settings().spacing;
    const double ball = spacing * std::cbrt(static_cast<double>(solver.particle_count()) * 3 / (4 * M_PI));
    const std::string name = fmt::format("R = {:.3g} spacings", spacings * resolution);
    Series round{name, {}, {}}, laplace{name, {}, {}};
    double settled = 0;
    int count = 0;
    for (int k = 0; k <= 50; ++k) {
      solver.advance_to(2.5 * k / 50);
      const FluidState state = solver.state();
      const double p = core_pressure(solver) / (2 * DropSetup::kTension / ball);
      round.x.push_back(state.time);
      round.y.push_back(asphericity(state, spacing));
      laplace.x.push_back(state.time);
      laplace.y.push_back(p);
      result.data.add({spacings * resolution, state.time, round.y.back(), gyration_ball(state) / ball, p});
      if (k > 40) settled += p, ++count;
    }
    // The tension acts in the particles, on average 0.7 spacings inside the surface.
    const double expected = 1 / (1 - 0.7 / (spacings * resolution));
    result.figures.push_back(at_least("asphericity of the cube, " + name, round.y.front(), 0.6));
    result.figures.push_back(at_most("asphericity at the end, " + name, round.y.back(), 0.1));
    result.figures.push_back(
        near_to("radius of the ball over that of the volume, " + name, gyration_ball(solver.state()) / ball, 1, 0.02));
    result.figures.push_back(
        near_to("pressure over Laplace's, tension 0.7 spacings inside: " + name, settled / count / expected, 1, 0.2));
    shape.series.push_back(round);
    pressure.series.push_back(laplace);
  }
  result.plots.plots = {shape, pressure};
  return result;
}

}  // namespace square_drop

ValidationCase square_drop_case() {
  return {"square_drop", "cube of fluid becomes round and keeps its volume; Laplace's pressure", false,
          square_drop::run};
}

}  // namespace flowskin::tools
