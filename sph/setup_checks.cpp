#include "sph/setup_checks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "common/number_text.h"
#include "sph/bodies/emitter_outlet.h"
#include "sph/bodies/fluid_sinks.h"
#include "sph/forces/surface_tension.h"
#include "sph/viscosity/rheology.h"

namespace flowskin::sph {

namespace {

/// An implicit step costs about as much as this many explicit ones (docs/viscosity.md).
constexpr double implicit_step_cost = 4;
constexpr double recommended_skin = 0.3;  // in spacings; measured in tests/benchmarks/sph_benchmark.cpp

void require(bool holds, const char* setting, double value, const char* expected) {
  if (!holds) {
    throw SettingsError(std::string("solver setting ") + setting + " = " + number_text(value) + ": expected " +
                        expected);
  }
}

void check_settings(const SolverSettings& s) {
  const auto positive = [](double v) { return std::isfinite(v) && v > 0; };
  const auto not_negative = [](double v) { return std::isfinite(v) && v >= 0; };
  require(positive(s.spacing), "spacing", s.spacing, "a length greater than 0 m");
  require(s.support_radius >= 1.5 && s.support_radius <= 4, "support_radius", s.support_radius, "1.5 to 4 spacings");
  require(positive(s.rest_density), "rest_density", s.rest_density, "a density greater than 0 kg/m^3");
  require(not_negative(s.viscosity), "viscosity", s.viscosity, "0 m^2/s or more");
  require(not_negative(s.surface_tension), "surface_tension", s.surface_tension, "0 N/m or more");
  require(s.gravity.allFinite(), "gravity", s.gravity.norm(), "finite numbers");
  require(not_negative(s.max_speed), "max_speed", s.max_speed, "0 (automatic) or a speed in m/s");
  require(not_negative(s.speed_of_sound), "speed_of_sound", s.speed_of_sound, "0 (automatic) or a speed in m/s");
  require(not_negative(s.background_pressure), "background_pressure", s.background_pressure,
          "0 (free surfaces) or a pressure in Pa");
  require(s.xsph >= 0 && s.xsph <= 1, "xsph", s.xsph, "0 to 1");
  require(s.particle_shifting >= 0 && s.particle_shifting <= 2, "particle_shifting", s.particle_shifting, "0 to 2");
  require(s.wall_drag >= 0 && s.wall_drag <= 1, "wall_drag", s.wall_drag, "0 to 1");
  require(s.density_diffusion >= 0 && s.density_diffusion <= 0.5, "density_diffusion", s.density_diffusion, "0 to 0.5");
  require(positive(s.acoustic_cfl), "acoustic_cfl", s.acoustic_cfl, "a number greater than 0");
  require(positive(s.viscous_cfl), "viscous_cfl", s.viscous_cfl, "a number greater than 0");
  require(positive(s.force_cfl), "force_cfl", s.force_cfl, "a number greater than 0");
  require(positive(s.capillary_cfl), "capillary_cfl", s.capillary_cfl, "a number greater than 0");
  require(positive(s.max_time_step), "max_time_step", s.max_time_step, "a time greater than 0 s");
  require(s.viscosity_tolerance >= 1e-6 && s.viscosity_tolerance <= 0.1, "viscosity_tolerance", s.viscosity_tolerance,
          "1e-6 to 0.1");
  require(s.viscosity_max_iterations >= 1, "viscosity_max_iterations", s.viscosity_max_iterations, "1 or more");
  require(s.skin >= 0 && s.skin <= 2, "skin", s.skin, "0 (automatic) to 2 spacings");
}

void check_domain(const SolverSettings& s) {
  for (int a = 0; a < 3; ++a) {
    const std::string axis(1, static_cast<char>('x' + a));
    const double length = s.domain.max[a] - s.domain.min[a];
    if (!std::isfinite(length) || length < 0) {
      throw SettingsError("the domain's min corner must not be greater than its max corner along " + axis);
    }
    // From here on no particle meets two images of another one.
    const double reach = std::max(s.support_radius * s.spacing, SurfaceTension(s).reach);
    const double shortest = 2 * reach;
    if (s.periodic[a] && length < shortest * (1 - 1e-9)) {
      throw SettingsError("the domain is periodic along " + axis + ", but only " + number_text(length) +
                          " m long; expected at least twice the support radius (with surface tension: six spacings), " +
                          number_text(shortest) + " m: a longer domain or a smaller spacing");
    }
  }
}

void check_mesh(const TriangleMesh& mesh, const std::string& name) {
  const int count = static_cast<int>(mesh.positions.size());
  for (const Vec3& p : mesh.positions) {
    if (!p.allFinite()) throw SettingsError(name + ": its mesh has a vertex that is not a finite number");
  }
  for (const auto& t : mesh.triangles) {
    for (const int v : t) {
      if (v < 0 || v >= count) {
        throw SettingsError(name + ": a triangle of its mesh names vertex " + std::to_string(v) + ", but there are " +
                            std::to_string(count) + " vertices");
      }
    }
  }
}

void check_motion(const Boundary& boundary, const std::string& name) {
  const std::vector<Keyframe>& keys = boundary.motion.keyframes;
  bool finite = boundary.motion.pivot.allFinite() && boundary.surface_velocity.allFinite();
  for (std::size_t k = 0; k < keys.size(); ++k) {
    finite = finite && std::isfinite(keys[k].time) && keys[k].translate.allFinite() && keys[k].rotate.allFinite();
    if (k > 0 && !(keys[k].time > keys[k - 1].time)) {
      throw SettingsError(name + ": keyframe " + std::to_string(k + 1) + " at " + number_text(keys[k].time) +
                          " s must be later than the one before it, at " + number_text(keys[k - 1].time) + " s");
    }
  }
  if (!finite) throw SettingsError(name + ": its motion has a number that is not finite");
}

void check_fluids(const SimulationSetup& setup) {
  const auto positive = [](double v) { return std::isfinite(v) && v > 0; };
  const std::size_t count = std::max<std::size_t>(1, setup.fluids.size());
  if (count > 255) throw SettingsError("there are " + std::to_string(count) + " fluids: expected at most 255");
  for (const Fluid& f : setup.fluids) {
    const Rheology& law = f.rheology;
    const auto expect = [&](bool holds, const char* what) {
      if (!holds) throw SettingsError("fluid \"" + f.name + "\": " + what);
    };
    expect(std::isfinite(f.viscosity) && f.viscosity >= 0, "its viscosity must be 0 m^2/s or more");
    expect(law.consistency >= 0 && law.yield_stress >= 0, "its consistency and yield stress must be 0 or more");
    expect(law.flow_index > 0 && law.flow_index <= 5, "its flow index must be above 0 and at most 5");
    expect(positive(law.regularization) && positive(law.max_viscosity),
           "its regularization and max_viscosity must be greater than 0");
  }
  const auto check = [&](const std::string& fluid, const std::string& name) {
    if (index_of(setup.fluids, fluid) < count) return;
    throw SettingsError(name + ": there is no fluid named \"" + fluid + "\"");
  };
  for (std::size_t b = 0; b < setup.bodies.size(); ++b) {
    check(setup.bodies[b].fluid, "fluid body " + std::to_string(b + 1));
  }
  for (std::size_t e = 0; e < setup.emitters.size(); ++e) {
    check(setup.emitters[e].fluid, "emitter " + std::to_string(e + 1));
  }
  if (is_mixture(setup.fluids) && setup.settings.viscosity_form == ViscosityForm::morris) {
    throw SettingsError(
        "viscosity_form morris does not know several fluids or viscosities that depend on the shear rate: choose "
        "monaghan");
  }
}

void check_shifting(const SimulationSetup& setup) {
  const SolverSettings& s = setup.settings;
  if (s.particle_shifting == 0) return;
  const auto expect = [](bool holds, const char* what) {
    if (!holds) throw SettingsError(std::string("particle_shifting is on: ") + what);
  };
  expect(s.density_method == DensityMethod::continuity, "expected density_method \"continuity\"");
  expect(s.xsph == 0, "expected xsph 0; only one of the two can move the particles");
  expect(s.surface_tension == 0,
         "it is for fluid that fills its space, which has no surface: expected surface_tension 0");
  expect(setup.emitters.empty() && setup.sinks.empty(),
         "it is for a constant amount of fluid: expected neither emitters nor sinks");
}

}  // namespace

void check_setup(const SimulationSetup& setup) {
  check_settings(setup.settings);
  check_shifting(setup);
  check_fluids(setup);
  check_domain(setup.settings);
  if (setup.bodies.empty() && setup.emitters.empty()) {
    throw SettingsError("nothing to simulate: give at least one fluid body or emitter");
  }
  for (std::size_t b = 0; b < setup.bodies.size(); ++b) {
    check_mesh(setup.bodies[b].mesh, "fluid body " + std::to_string(b + 1));
  }
  for (std::size_t e = 0; e < setup.emitters.size(); ++e) {
    check_mesh(setup.emitters[e].mesh, "emitter " + std::to_string(e + 1));
  }
  for (std::size_t k = 0; k < setup.sinks.size(); ++k) {
    check_mesh(setup.sinks[k].mesh, "sink " + std::to_string(k + 1));
    check_sink(setup.sinks[k], "sink " + std::to_string(k + 1));
  }
  for (std::size_t b = 0; b < setup.boundaries.size(); ++b) {
    const std::string name = "boundary " + std::to_string(b + 1);
    check_mesh(setup.boundaries[b].mesh, name);
    if (setup.boundaries[b].mesh.triangles.empty()) throw SettingsError(name + ": its mesh has no triangles");
    check_motion(setup.boundaries[b], name);
    if (!(setup.boundaries[b].slip >= 0 && setup.boundaries[b].slip <= 1)) {
      throw SettingsError(name + ": slip = " + number_text(setup.boundaries[b].slip) +
                          ": expected 0 (no-slip) to 1 (free slip)");
    }
    const double adhesion = setup.boundaries[b].adhesion;
    if (!(adhesion >= 0 && adhesion <= 2)) {
      throw SettingsError(name + ": adhesion = " + number_text(adhesion) + ": expected 0 (not wetted) to 2");
    }
    if (adhesion > 0 && !(setup.settings.surface_tension > 0)) {
      throw SettingsError(name + ": adhesion = " + number_text(adhesion) +
                          " is a share of the surface tension, which is 0: set surface_tension too");
    }
  }
}

SolverSettings with_automatic_values(const SimulationSetup& setup, const Box& fluid_box, double fluid_speed) {
  SolverSettings s = setup.settings;
  if (s.skin == 0) s.skin = recommended_skin;
  const double g = s.gravity.norm();
  if (s.max_speed == 0) {
    const Vec3 down = g > 0 ? Vec3(s.gravity / g) : Vec3::Zero();
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
    s.max_speed = std::sqrt(speed * speed + 2 * g * std::max(0.0, bottom - top));
    // Fluid at rest without gravity: any speed of sound will do.
    if (s.max_speed == 0) s.max_speed = 50 * s.spacing;
  }
  if (s.speed_of_sound == 0) s.speed_of_sound = std::max(10 * s.max_speed, capillary_speed_of_sound(s));
  if (!setup.fluids.empty()) s.viscosity = 0;
  for (const Fluid& fluid : setup.fluids) s.viscosity = std::max(s.viscosity, greatest_viscosity(fluid));
  if (s.viscosity_solver == ViscositySolver::automatic) {
    const double h = s.support_radius * s.spacing / 2;
    const double longest = std::min(s.acoustic_cfl * h / s.speed_of_sound, s.max_time_step);
    s.viscosity_solver = implicit_step_cost * viscous_step_limit(s, s.viscosity) < longest
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
