// A viscous drop spreads on a plane: R = 0.894 (g V^3 / (3 nu))^(1/8) t^(1/8) [Huppert 1982, Eq. 2.23b].
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/validation/flow_setup.h"
#include "tools/validation/thin_film.h"
#include "tools/validation/validation_case.h"

namespace flowskin::tools {
namespace gravity_current {

using sph::Vec3;

constexpr double kRadius = 1, kHeight = 1, kGravity = 10;  // m, m/s^2
// Where the law is fitted. It holds for sheets that are thin and have forgotten how they began: by the lubrication
// equation, which takes them as thin from the start, the exponent is within 0.001 of 1/8 from 1.8 radii on; a cylinder
// as high as wide first has to fall, and follows from 1.9 radii on.
constexpr double kFittedFrom = 2 * kRadius, kFittedTo = 2.6 * kRadius;
constexpr double kViscosity = 0.4;  // m^2/s; g R0^3 / nu^2 = 62: inertia does not matter

// A quarter of a cylinder between two planes of symmetry.
sph::SimulationSetup quarter(int across) {
  const double spacing = kRadius / across, floor = 3.8 * kRadius, top = 1.5 * kHeight;
  sph::SimulationSetup setup = flow_setup(spacing, kViscosity, {0, -kGravity, 0});
  // The fluid falls by itself, braked by its viscosity: far slower than in free fall.
  setup.settings.max_speed = 1.0;
  for (int i = 0; i < across; ++i) {
    for (int j = 0; j < across; ++j) {
      if (std::hypot(i + 0.5, j + 0.5) > across) continue;
      const Vec3 corner(i * spacing, 0, j * spacing);
      setup.bodies.push_back(block_body(corner, corner + Vec3(spacing, kHeight, spacing)));
    }
  }
  setup.boundaries.push_back(plane_wall({0, 0, 0}, {0, 0, floor}, {floor, 0, 0}, 0));
  setup.boundaries.push_back(plane_wall({0, 0, 0}, {floor, 0, 0}, {0, top, 0}, 1));
  setup.boundaries.push_back(plane_wall({0, 0, 0}, {0, top, 0}, {0, 0, floor}, 1));
  return setup;
}

// Mean over 16 directions of the farthest particle, half a spacing ahead of its centre.
double front_radius(const sph::FluidState& state, double spacing) {
  constexpr int sectors = 16;
  double farthest[sectors] = {};
  for (const Vec3& p : state.positions) {
    const double angle = std::atan2(std::max(0.0, p.z()), p.x()) / (0.5 * std::numbers::pi);
    double& r = farthest[std::clamp(static_cast<int>(angle * sectors), 0, sectors - 1)];
    r = std::max(r, std::hypot(p.x(), p.z()));
  }
  double sum = 0;
  for (const double r : farthest) sum += r;
  return sum / sectors + 0.5 * spacing;
}

ValidationResult run(double resolution) {
  const int across = static_cast<int>(std::lround(24 * resolution));
  sph::Solver solver(quarter(across));
  const double spacing = kRadius / across;
  const double volume = 4 * static_cast<double>(solver.particle_count()) * std::pow(spacing, 3);
  const double scale = std::pow(kGravity * std::pow(volume, 3) / (3 * kViscosity), 0.125);
  const auto time_of = [&](double r) { return std::pow(r / (0.894 * scale), 8); };

  ValidationResult result;
  result.data.columns = {"time_s", "radius_m", "reference_m", "lubrication_m"};
  Series computed{"computed", {}, {}}, reference{"Huppert 1982", {}, {}}, sheet{"lubrication equation", {}, {}};
  SpreadingCylinder cylinder;
  cylinder.radius = kRadius, cylinder.height = volume / (std::numbers::pi * kRadius * kRadius);
  cylinder.gravity = kGravity, cylinder.viscosity = kViscosity, cylinder.farthest = 1.1 * kFittedTo;
  const SpreadingFront lubrication = spread(cylinder);
  std::vector<double> log_time, log_radius;
  double coefficient = 0, farthest_off = 0;
  constexpr int steps = 40;
  const double first = time_of(1.2 * kRadius), last = time_of(kFittedTo);
  for (int n = 0; n <= steps; ++n) {
    const double t = first * std::pow(last / first, static_cast<double>(n) / steps);
    solver.advance_to(t);
    const double r = front_radius(solver.state(), spacing), wanted = 0.894 * scale * std::pow(t, 0.125);
    computed.x.push_back(t), computed.y.push_back(r);
    reference.x.push_back(t), reference.y.push_back(wanted);
    const double thin = lubrication.radius_at(t);
    sheet.x.push_back(t), sheet.y.push_back(thin);
    result.data.add({t, r, wanted, thin});
    if (r < kFittedFrom) continue;
    log_time.push_back(std::log(t)), log_radius.push_back(std::log(r));
    coefficient += 0.894 * r / wanted;
    farthest_off = std::max(farthest_off, std::abs(r / thin - 1));
  }
  coefficient /= static_cast<double>(std::max<std::size_t>(1, log_time.size()));
  result.figures = {
      near_to("exponent of R(t)", fitted_slope(log_time, log_radius), 0.125, 0.01),
      near_to("coefficient of R(t)", coefficient, 0.894, 0.0894),
      at_most("largest deviation from the lubrication equation (share of the radius)", farthest_off, 0.03),
      at_most("paths through a wall", static_cast<double>(solver.statistics().wall_crossings), 0),
  };
  Plot plot = line_plot("Viscous gravity current", "time (s)", "radius (m)", {computed, reference, sheet});
  plot.log_x = plot.log_y = true;
  result.plots.plots = {plot};
  return result;
}

}  // namespace gravity_current

ValidationCase gravity_current_case() {
  return {"gravity_current", "a viscous drop spreads on a plane, radius against Huppert 1982", false,
          gravity_current::run};
}

}  // namespace flowskin::tools
