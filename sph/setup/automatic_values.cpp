#include "sph/setup/automatic_values.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sph/forces/surface_tension.h"
#include "sph/viscosity/rheology.h"

namespace flowskin::sph {

namespace {

/// An implicit step costs about as much as this many explicit ones (docs/viscosity.md).
constexpr double kImplicitStepCost = 4;
constexpr double kRecommendedSkin = 0.3;  // in spacings; measured in tests/benchmarks/sph_benchmark.cpp
/// Fluid at rest without gravity: any speed of sound will do. Spacings a second.
constexpr double kSlowestInSpacings = 50;

// Speed of fluid that falls from the highest fluid or emitter to the lowest point of the walls.
double speed_of_fall(const SimulationSetup& setup, const Box& fluid_box, double fluid_speed) {
  const Vec3& gravity = setup.settings.gravity;
  const double g = gravity.norm();
  const Vec3 down = g > 0 ? Vec3(gravity / g) : Vec3::Zero();
  // Depth along gravity of the highest and the lowest corner of a box, and of points.
  double top = 1e300, fluid_bottom = -1e300, wall_bottom = -1e300, speed = fluid_speed;
  if (!setup.bodies.empty()) {
    for (int k = 0; k < 8; ++k) {
      const Vec3 corner((k & 1 ? fluid_box.max : fluid_box.min).x(), (k & 2 ? fluid_box.max : fluid_box.min).y(),
                        (k & 4 ? fluid_box.max : fluid_box.min).z());
      top = std::min(top, corner.dot(down));
      fluid_bottom = std::max(fluid_bottom, corner.dot(down));
    }
  }
  for (const Emitter& e : setup.emitters) {
    top = std::min(top, e.center.dot(down));
    fluid_bottom = std::max(fluid_bottom, e.center.dot(down));
    speed = std::max(speed, e.speed);
  }
  for (const Boundary& b : setup.boundaries) {
    for (const Vec3& p : b.mesh.positions) wall_bottom = std::max(wall_bottom, p.dot(down));
  }
  const double bottom = setup.boundaries.empty() ? fluid_bottom : std::max(wall_bottom, fluid_bottom);
  return std::sqrt(speed * speed + 2 * g * std::max(0.0, bottom - top));
}

}  // namespace

SolverSettings with_automatic_values(const SimulationSetup& setup, const Box& fluid_box, double fluid_speed) {
  SolverSettings s = setup.settings;
  if (s.skin == 0) s.skin = kRecommendedSkin;
  if (s.max_speed == 0) s.max_speed = speed_of_fall(setup, fluid_box, fluid_speed);
  if (s.max_speed == 0) s.max_speed = kSlowestInSpacings * s.spacing;
  if (s.speed_of_sound == 0) s.speed_of_sound = std::max(10 * s.max_speed, capillary_speed_of_sound(s));
  if (!setup.fluids.empty()) s.viscosity = 0;
  for (const Fluid& fluid : setup.fluids) s.viscosity = std::max(s.viscosity, greatest_viscosity(fluid));
  if (s.viscosity_solver == ViscositySolver::automatic) {
    const double h = s.support_radius * s.spacing / 2;
    const double longest = std::min(s.acoustic_cfl * h / s.speed_of_sound, s.max_time_step);
    s.viscosity_solver = kImplicitStepCost * viscous_step_limit(s, s.viscosity) < longest
                             ? ViscositySolver::implicit
                             : ViscositySolver::explicit_steps;
  }
  return s;
}

double viscous_step_limit(const SolverSettings& s, double viscosity) {
  if (viscosity <= 0) return std::numeric_limits<double>::infinity();
  const double h = s.support_radius * s.spacing / 2;
  return s.viscous_cfl * (s.viscosity_form == ViscosityForm::monaghan ? 0.5 : 1.0) * h * h / viscosity;
}

}  // namespace flowskin::sph
