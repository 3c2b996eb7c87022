// What fluid without walls keeps: momentum, angular momentum; and its energy, which viscosity only lowers.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "sph/walls/wall_kernel.h"
#include "tools/validation/flow_setup.h"
#include "tools/validation/validation_case.h"

namespace flowskin::tools {
namespace conservation {

using sph::Vec3;

constexpr double kEnd = 0.6;  // s; the bodies touch at 0.05 s and are one lump at the end

// A drop and a block that turn hit each other off centre; nothing else acts.
sph::SimulationSetup collision(int particles_across, double viscosity) {
  const double spacing = 0.5 / particles_across;
  sph::SimulationSetup setup = flow_setup(spacing, viscosity, Vec3::Zero());
  setup.bodies.push_back(ball_body({-0.3, 0, 0}, 0.25, {1, 0.1, 0}));
  setup.bodies.push_back(block_body({0.05, 0, -0.2}, {0.45, 0.4, 0.2}, {-1, 0, 0.2}));
  setup.bodies[0].angular_velocity = {0, 3, 1};
  return setup;
}

struct Totals {
  Vec3 momentum = Vec3::Zero(), angular_momentum = Vec3::Zero();
  double kinetic = 0, compression = 0;  // J
  double speeds = 0, moments = 0;       // sums of m |v| and m |x| |v|: the scale of rounding

  double energy() const { return kinetic + compression; }
};

// Energy (J/kg) of compressed fluid: the integral of p / rho^2 for Tait's pressure, which is 0 below the rest density.
double compression_energy(double ratio, double speed_of_sound) {
  const double c2 = speed_of_sound * speed_of_sound;
  return ratio <= 1 ? 0 : c2 / 7 * (std::pow(ratio, 6) / 6 + 1 / ratio - 7.0 / 6);
}

Totals totals(const sph::Solver& solver) {
  const sph::FluidState state = solver.state();
  const sph::SolverSettings& settings = solver.settings();
  const double mass = settings.rest_density * std::pow(settings.spacing, 3);
  Totals sum;
  for (std::size_t i = 0; i < state.ids.size(); ++i) {
    const Vec3 &x = state.positions[i], &v = state.velocities[i];
    sum.momentum += mass * v;
    sum.angular_momentum += mass * x.cross(v);
    sum.kinetic += 0.5 * mass * v.squaredNorm();
    sum.compression += mass * compression_energy(state.densities[i] / settings.rest_density, settings.speed_of_sound);
    sum.speeds += mass * v.norm();
    sum.moments += mass * v.norm() * x.norm();
  }
  return sum;
}

ValidationResult run(double resolution) {
  const int across = static_cast<int>(std::lround(12 * resolution));
  ValidationResult result;
  result.data.columns = {"viscosity_m2_per_s", "time_s", "kinetic_energy_j", "compression_energy_j"};
  Plot plot = line_plot("Energy", "time (s)", "energy / energy at the start", {});
  double momentum = 0, angular = 0;
  for (const double viscosity : {0.0, 1e-3, 1e-2, 1e-1}) {
    sph::Solver solver(collision(across, viscosity));
    const Totals start = totals(solver);
    Series series{fmt::format("ν = {} m²/s", viscosity), {}, {}};
    double highest_rise = 0, lowest = start.energy();
    for (int k = 0; k <= 120; ++k) {
      solver.advance_to(kEnd * k / 120);
      const Totals now = totals(solver);
      momentum = std::max(momentum, (now.momentum - start.momentum).norm() / start.speeds);
      angular = std::max(angular, (now.angular_momentum - start.angular_momentum).norm() / start.moments);
      highest_rise = std::max(highest_rise, (now.energy() - lowest) / start.energy());
      lowest = std::min(lowest, now.energy());
      series.x.push_back(solver.time());
      series.y.push_back(now.energy() / start.energy());
      result.data.add({viscosity, solver.time(), now.kinetic, now.compression});
    }
    plot.series.push_back(series);
    result.figures.push_back(at_most(
        fmt::format("greatest rise of the energy at viscosity {}, share of the start", viscosity), highest_rise, 1e-3));
  }
  result.figures.push_back(at_most("change of momentum, share of sum m |v|", momentum, 1e-6));
  result.figures.push_back(at_most("change of angular momentum, share of sum m |x| |v|", angular, 1e-6));
  plot.note = "kinetic energy and that of compression; two bodies collide, no walls, no gravity";
  result.plots.plots = {plot};
  return result;
}

}  // namespace conservation

ValidationCase conservation_case() {
  return {"conservation", "two bodies collide without walls: momentum, angular momentum, energy", true,
          conservation::run};
}

}  // namespace flowskin::tools
