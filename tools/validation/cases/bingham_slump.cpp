// A block of a fluid with a yield stress that slumps on a plane and stops: its final shape.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/validation/flow_setup.h"
#include "tools/validation/validation_case.h"

namespace flowskin::tools {
namespace bingham_slump {

using sph::Vec3;

constexpr double kEdge = 0.2;         // m, of the half block: the other half is behind a free-slip wall
constexpr double kGravity = 9.81;     // m/s^2
constexpr double kYieldStress = 140;  // Pa
constexpr double kEnd = 2;            // s

// A heap that has yielded everywhere and stopped. The yield stress acts on its base, and the horizontal force on a
// section balances it: d/dx(rho g h^2 / 2 - c tau_y h) = -tau_y, so h^2 - 2 c s h = 2 s (front - x) with s = tau_y /
// (rho g). For a very shallow heap c = 0 [Liu and Mei 1989]. As it spreads, the stress along x exceeds the vertical one
// by 2 sqrt(tau_y^2 - tau^2), with the shear tau growing linearly from the surface to the base: integrated over the
// height that is pi / 2 tau_y h, so c = pi / 2 (as Nye 1951; not checked). The heap then ends in a cliff 2 c s
// high.
struct FinalShape {
  double slope = kYieldStress / (1000 * kGravity), cliff = 0, front = 0;

  explicit FinalShape(double normal_stress) : cliff(2 * normal_stress * slope) {
    double low = 0, high = 10 * kEdge;
    for (int k = 0; k < 60; ++k) {
      front = 0.5 * (low + high);
      (volume() > kEdge * kEdge ? high : low) = front;
    }
  }
  double height(double x) const {
    return 0.5 * cliff + std::sqrt(0.25 * cliff * cliff + 2 * slope * std::max(0.0, front - x));
  }
  double volume() const {  // per width (m^2)
    const double half = 0.5 * cliff;
    return half * front + (std::pow(half * half + 2 * slope * front, 1.5) - std::pow(half, 3)) / (3 * slope);
  }
};

ValidationResult run(double resolution) {
  const int across = static_cast<int>(std::lround(14 * resolution));
  const double spacing = kEdge / across, width = 5 * spacing;
  sph::SimulationSetup setup = flow_setup(spacing, 0, {0, -kGravity, 0});
  sph::Fluid mud;
  mud.name = "mud";
  mud.viscosity = 0.01;
  mud.rheology.yield_stress = kYieldStress;
  mud.rheology.regularization = 300;
  mud.rheology.max_viscosity = 20;
  setup.fluids = {mud};
  setup.settings.max_speed = 1.5;
  setup.settings.domain = {{-1, -1, 0}, {2, 1, width}};
  setup.settings.periodic = {false, false, true};
  setup.bodies.push_back(block_body({0, 0, 0}, {kEdge, kEdge, width}));
  setup.boundaries.push_back(plane_wall({-0.02, 0, 0}, {0, 0, width}, {1.5, 0, 0}, 0));
  setup.boundaries.push_back(plane_wall({0, 0, 0}, {0, 0.4, 0}, {0, 0, width}, 1));

  sph::Solver solver(setup);
  ValidationResult result;
  result.data.columns = {"time_s", "front_m", "height_at_wall_m"};
  Series fronts{"computed", {}, {}};
  sph::FluidState state;
  double front = 0, height = 0, front_before = 0;
  for (int k = 0; k <= 40; ++k) {
    solver.advance_to(kEnd * k / 40);
    state = solver.state();
    front = height = 0;
    for (const Vec3& p : state.positions) {
      front = std::max(front, p.x() + 0.5 * spacing);
      if (p.x() < 2 * spacing) height = std::max(height, p.y() + 0.5 * spacing);
    }
    if (k == 30) front_before = front;
    fronts.x.push_back(solver.time());
    fronts.y.push_back(front);
    result.data.add({solver.time(), front, height});
  }
  // The surface: highest particle in every column two spacings wide.
  Series surface{"computed", {}, {}}, theory{"theory", {}, {}}, shallow{"theory, very shallow", {}, {}};
  for (double x = 0; x < front; x += 2 * spacing) {
    double top = 0;
    for (const Vec3& p : state.positions) {
      if (p.x() >= x && p.x() < x + 2 * spacing) top = std::max(top, p.y() + 0.5 * spacing);
    }
    if (top == 0) continue;
    surface.x.push_back(x + spacing);
    surface.y.push_back(top);
  }
  surface.x.push_back(front), surface.y.push_back(0);
  const FinalShape shape(std::numbers::pi / 2), shallow_shape(0);
  const auto add = [](const FinalShape& form, Series& series) {
    for (int k = 0; k <= 100; ++k) {
      series.x.push_back(form.front * k / 100);
      series.y.push_back(form.height(form.front * k / 100));
    }
    series.x.push_back(form.front), series.y.push_back(0);
  };
  add(shape, theory);
  add(shallow_shape, shallow);
  result.figures = {
      near_to("front where it stops, share of theory", front / shape.front, 1, 0.1),
      near_to("height where it stops, share of theory", height / shape.height(0), 1, 0.1),
      at_most("motion of the front in the last quarter, share of its way", (front - front_before) / (front - kEdge),
              0.03),
  };
  result.plots.plots = {line_plot("Where it stops", "x (m)", "height (m)", {theory, surface, shallow}),
                        line_plot("Front", "time (s)", "x (m)", {fronts})};
  return result;
}

}  // namespace bingham_slump

ValidationCase bingham_slump_case() {
  return {"bingham_slump", "a block of mud that slumps and stops, against the balance of pressure and yield stress",
          false, bingham_slump::run};
}

}  // namespace flowskin::tools
