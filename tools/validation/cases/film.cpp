// A film flows down an incline: u = g sin(a) / nu (H y - y^2 / 2) [Nusselt 1916].
#include <cmath>
#include <numbers>

#include "tools/validation/flow_setup.h"
#include "tools/validation/validation_case.h"

namespace flowskin::tools {
namespace film {

using sph::Vec3;

constexpr double kDepth = 0.01, kGravity = 9.81, kAngle = 30 * std::numbers::pi / 180;  // m, m/s^2
constexpr double kReynolds = 1;  // surface speed times depth / nu

// Axes along (x) and across (y) the incline; endless along it and sideways.
sph::SimulationSetup film(int layers, double viscosity) {
  const double spacing = kDepth / layers, length = 6 * spacing;
  sph::SimulationSetup setup = flow_setup(spacing, viscosity, kGravity * Vec3(std::sin(kAngle), -std::cos(kAngle), 0));
  setup.settings.max_speed = std::sqrt(2 * kGravity * kDepth);
  add_endless_floor(length, setup);
  setup.bodies.push_back(block_body({0, 0, 0}, {length, kDepth, length}));
  return setup;
}

ValidationResult run(double resolution) {
  const int layers = static_cast<int>(std::lround(16 * resolution));
  const double spacing = kDepth / layers;
  const double viscosity = std::sqrt(kGravity * std::sin(kAngle) * std::pow(kDepth, 3) / (2 * kReynolds));
  const double surface_speed = kGravity * std::sin(kAngle) * kDepth * kDepth / (2 * viscosity);
  sph::Solver solver(film(layers, viscosity));
  // Slowest mode: exp(-pi^2 / 4 nu t / H^2); then the mean of ten states.
  ValidationResult result;
  result.data.columns = {"distance_from_wall_m", "speed_m_per_s", "reference_m_per_s"};
  Series computed{"computed", {}, {}}, reference{"Nusselt", {}, {}};
  double error = 0, norm = 0;
  double top = 0, top_reference = 0, slip_sum = 0, slip_weight = 0;
  constexpr int states = 10;
  for (int n = 0; n < states; ++n) {
    solver.advance_to((3 + 0.1 * n) * kDepth * kDepth / viscosity);
    const sph::FluidState state = solver.state();
    const auto height = [&](std::size_t i) { return state.positions[i].y(); };
    const auto speed = [&](std::size_t i) { return state.velocities[i].x(); };
    const LayerMeans profile = layer_means(state, 0, spacing, height, speed);
    for (std::size_t k = 0; k < profile.centers.size(); ++k) {
      const double y = profile.centers[k], wanted = surface_speed * (2 * y / kDepth - y * y / (kDepth * kDepth));
      error += std::pow(profile.means[k] - wanted, 2), norm += wanted * wanted;
      if (n + 1 < states) continue;
      computed.x.push_back(y), computed.y.push_back(profile.means[k]);
      reference.x.push_back(y), reference.y.push_back(wanted);
      result.data.add({y, profile.means[k], wanted});
    }
    top += profile.means.back() / states;
    const double y = profile.centers.back();
    top_reference += surface_speed * (2 * y / kDepth - y * y / (kDepth * kDepth)) / states;
    // The speed at the wall: a straight line through the two lowest layers, less the parabola's own curvature.
    const double y0 = profile.centers[0], y1 = profile.centers[1];
    const double slope = (profile.means[1] - profile.means[0]) / (y1 - y0);
    slip_sum += profile.means[0] - slope * y0 - surface_speed * y0 * y1 / (kDepth * kDepth);
    slip_weight += surface_speed;
  }
  result.figures = {
      near_to("speed of the top layer over Nusselt's", top / top_reference, 1, 0.03),
      at_most("relative L2 error of the profile", std::sqrt(error / norm), 0.03),
      near_to("speed at the wall over that of the surface", slip_sum / slip_weight, 0, 0.02),
      at_most("paths through the wall", static_cast<double>(solver.statistics().wall_crossings), 0),
  };
  Plot plot =
      line_plot("Film on an incline of 30°", "distance from the wall (m)", "speed (m/s)", {computed, reference});
  result.plots.plots = {plot};
  return result;
}

}  // namespace film

ValidationCase film_case() {
  return {"film", "a film flowing down an incline against Nusselt's parabola", true, film::run};
}

}  // namespace flowskin::tools
