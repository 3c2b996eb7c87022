#include "sph/setup/setup_checks.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "common/number_text.h"
#include "sph/bodies/emitter_outlet.h"
#include "sph/bodies/fluid_sinks.h"
#include "sph/forces/surface_tension.h"
#include "sph/setup/errors.h"
#include "sph/viscosity/rheology.h"

namespace flowskin::sph {

namespace {

// Coordinates of meshes (m): beyond it what doubles hold is no longer fine enough for fluid beside the mesh.
constexpr double kFarthestVertex = 1e9;

std::string in_words(const Range& range, std::string_view unit) {
  const std::string end = unit.empty() ? "" : " " + std::string(unit);
  return (range.open_min ? "more than " : "") + number_text(range.min) + (range.open_min ? " and at most " : " to ") +
         number_text(range.max) + end;
}

void require(const std::string& name, double value, const Range& range, std::string_view unit = {}) {
  if (range.holds(value)) return;
  throw SettingsError(name + " = " + number_text(value) + ": expected " + in_words(range, unit));
}

template <class Table, class Value>
void require_name(const char* setting, const Table& table, Value value) {
  if (!name_of(table, value).empty()) return;
  throw SettingsError(std::string("solver setting ") + setting + " has none of its values: expected " +
                      names_in_words(table));
}

void check_settings(const SolverSettings& s) {
  for (const NumberSetting& number : kNumberSettings) {
    require("solver setting " + std::string(number.name), s.*number.value, number.range, number.unit);
  }
  require("solver setting viscosity_max_iterations", s.viscosity_max_iterations, kViscosityIterations);
  for (int a = 0; a < 3; ++a) {
    require("solver setting gravity, component " + std::string(1, static_cast<char>('x' + a)), s.gravity[a],
            at_least(-kGreatestGravity, kGreatestGravity), "m/s^2");
  }
  require_name("kernel", kKernelNames, s.kernel);
  require_name("density_method", kDensityMethodNames, s.density_method);
  require_name("viscosity_form", kViscosityFormNames, s.viscosity_form);
  require_name("viscosity_solver", kViscositySolverNames, s.viscosity_solver);
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
    if (!(p.cwiseAbs().maxCoeff() <= kFarthestVertex)) {
      throw SettingsError(name + ": its mesh has a vertex at (" + number_text(p.x(), 4) + ", " + number_text(p.y(), 4) +
                          ", " + number_text(p.z(), 4) + ") m, farther out than " + number_text(kFarthestVertex, 4) +
                          " m: does it stray?");
    }
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
  const std::size_t count = std::max<std::size_t>(1, setup.fluids.size());
  if (count > 255) throw SettingsError("there are " + std::to_string(count) + " fluids: expected at most 255");
  for (const Fluid& f : setup.fluids) {
    const std::string start = "fluid \"" + f.name + "\": ";
    require(start + "viscosity", f.viscosity, range_of(&SolverSettings::viscosity), "m^2/s");
    for (const RheologyNumber& number : kRheologyNumbers) {
      require(start + std::string(number.name), f.rheology.*number.value, number.range, number.unit);
    }
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
        "viscosity_form morris does not support several fluids or viscosities that depend on the shear rate: choose "
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
    const double adhesion = setup.boundaries[b].adhesion;
    require(name + ": slip (0: no slip, 1: free slip)", setup.boundaries[b].slip, kSlip);
    require(name + ": adhesion (0: not wetted)", adhesion, kAdhesion);
    if (adhesion > 0 && !(setup.settings.surface_tension > 0)) {
      throw SettingsError(name + ": adhesion = " + number_text(adhesion) +
                          " is a share of the surface tension, which is 0: set surface_tension too");
    }
  }
}

}  // namespace flowskin::sph
