// A column of fluid comes to rest in a box: p = rho g (H - y), and its motion dies out.
#include <algorithm>
#include <cmath>

#include "tools/validation/flow_setup.h"
#include "tools/validation/validation_case.h"

namespace flowskin::tools {
namespace hydrostatic {

using sph::Vec3;

// Viscous enough that the sound of the start, which rings along the column with nothing to stop it, dies out in some
// seconds.
constexpr double kHeight = 1, kGravity = 9.81, kViscosity = 0.5;

// The column is periodic in both horizontal directions, an endless pool. Between walls the pressure of the middle would
// be higher by the share of the outermost half layer: walls push, but do not carry, and fluid beside them lacks
// neighbours.
sph::SimulationSetup column(int layers) {
  const double spacing = kHeight / layers, width = 8 * spacing;
  sph::SimulationSetup setup = flow_setup(spacing, kViscosity, {0, -kGravity, 0});
  add_endless_floor(width, setup);
  setup.bodies.push_back(block_body({0, 0, 0}, {width, kHeight, width}));
  return setup;
}

ValidationResult run(double resolution) {
  const int layers = static_cast<int>(std::lround(20 * resolution));
  sph::Solver solver(column(layers));
  const double mass = 1000 * std::pow(kHeight / layers, 3) * static_cast<double>(solver.particle_count());
  const double scale = mass * kGravity * kHeight;  // J
  Series energy{"kinetic energy / (m g H)", {}, {}};
  const double end = 4;
  for (int k = 1; k <= 80; ++k) {
    solver.advance_to(end * k / 80);
    energy.x.push_back(solver.time());
    energy.y.push_back(solver.energy().kinetic / scale);
  }
  const double early = *std::max_element(energy.y.begin(), energy.y.begin() + 20);
  const double late = *std::max_element(energy.y.end() - 20, energy.y.end());

  const sph::FluidState state = solver.state();
  const std::vector<double> pressure = pressures(state, solver.settings());
  // As thick as the kernel reaches: the force sees the mean pressure of neighbouring layers of particles only, and at
  // rest the lattice of the start alternates by 2.5 % about it.
  const LayerMeans profile = layer_means(
      state, 0, 2 * kHeight / layers, [&](std::size_t i) { return state.positions[i].y(); },
      [&](std::size_t i) { return pressure[i]; });
  const double bottom = 1000 * kGravity * kHeight;
  Series computed{"computed", {}, {}}, reference{"ρ g (H − y)", {}, {}};
  ValidationResult result;
  result.data.columns = {"height_m", "pressure_pa", "reference_pa"};
  double worst = 0;
  for (std::size_t k = 0; k < profile.centers.size(); ++k) {
    const double y = profile.centers[k], wanted = std::max(0.0, bottom * (1 - y / kHeight));
    worst = std::max(worst, std::abs(profile.means[k] - wanted) / bottom);
    computed.x.push_back(y), computed.y.push_back(profile.means[k]);
    reference.x.push_back(y), reference.y.push_back(wanted);
    result.data.add({y, profile.means[k], wanted});
  }
  result.figures = {
      at_most("largest error of the mean pressure of a layer, share of the greatest", worst, 0.02),
      at_most("relative L2 error of the pressure", relative_l2(computed.y, reference.y), 0.02),
      at_most("kinetic energy in the last quarter, share of m g H", late, 1e-5),
      at_most("kinetic energy, last quarter over first quarter", late / early, 0.1),
      at_most("paths through a wall", static_cast<double>(solver.statistics().wall_crossings), 0),
  };
  result.plots.title = "Hydrostatic column";
  result.plots.plots = {line_plot("Pressure", "height (m)", "pressure (Pa)", {computed, reference}),
                        line_plot("Motion", "time (s)", "kinetic energy / (m g H)", {energy})};
  result.plots.plots[1].log_y = true;
  return result;
}

}  // namespace hydrostatic

ValidationCase hydrostatic_case() {
  return {"hydrostatic", "a column at rest in a box against p = rho g (H - y); its motion dies out", true,
          hydrostatic::run};
}

}  // namespace flowskin::tools
