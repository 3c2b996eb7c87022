// A block of a fluid with a yield stress that slumps on a plane and stops: its final shape.
#include <algorithm>
#include <cmath>

#include "tools/validation/flow_setup.h"
#include "tools/validation/validation_case.h"

namespace flowskin::tools {
namespace {

using sph::Vec3;

constexpr double edge = 0.2;          // m, of the half block: the other half is behind a free-slip wall
constexpr double gravity = 9.81;      // m/s^2
constexpr double yield_stress = 140;  // Pa
constexpr double end = 2;             // s

// Where a shallow heap has stopped, pressure gradient and yield stress balance, rho g h dh/dx = -tau_y [Liu and Mei
// 1989], so h^2 = 2 tau_y / (rho g) (front - x); the front follows from the volume.
struct FinalShape {
  double slope = yield_stress / (1000 * gravity);
  double front = std::cbrt(std::pow(1.5 * edge * edge, 2) / (2 * slope));
  double height(double x) const { return std::sqrt(2 * slope * std::max(0.0, front - x)); }
};

ValidationResult run(double resolution) {
  const int across = static_cast<int>(std::lround(14 * resolution));
  const double spacing = edge / across, width = 5 * spacing;
  sph::SimulationSetup setup = flow_setup(spacing, 0, {0, -gravity, 0});
  sph::Fluid mud;
  mud.name = "mud";
  mud.viscosity = 0.01;
  mud.rheology.yield_stress = yield_stress;
  mud.rheology.regularization = 300;
  mud.rheology.max_viscosity = 20;
  setup.fluids = {mud};
  setup.settings.max_speed = 1.5;
  setup.settings.domain = {{-1, -1, 0}, {2, 1, width}};
  setup.settings.periodic = {false, false, true};
  setup.bodies.push_back(block_body({0, 0, 0}, {edge, edge, width}));
  setup.boundaries.push_back(plane_wall({-0.02, 0, 0}, {0, 0, width}, {1.5, 0, 0}, 0));
  setup.boundaries.push_back(plane_wall({0, 0, 0}, {0, 0.4, 0}, {0, 0, width}, 1));

  sph::Solver solver(setup);
  ValidationResult result;
  result.data.columns = {"time_s", "front_m", "height_at_wall_m"};
  Series fronts{"computed", {}, {}};
  sph::FluidState state;
  double front = 0, height = 0, front_before = 0;
  for (int k = 0; k <= 40; ++k) {
    solver.advance_to(end * k / 40);
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
  Series surface{"computed", {}, {}}, theory{"theory", {}, {}};
  for (double x = 0; x < front; x += 2 * spacing) {
    double top = 0;
    for (const Vec3& p : state.positions) {
      if (p.x() >= x && p.x() < x + 2 * spacing) top = std::max(top, p.y() + 0.5 * spacing);
    }
    surface.x.push_back(x + spacing);
    surface.y.push_back(top);
  }
  const FinalShape shape;
  for (int k = 0; k <= 100; ++k) {
    theory.x.push_back(shape.front * k / 100);
    theory.y.push_back(shape.height(shape.front * k / 100));
  }
  result.figures = {
      near_to("front where it stops, share of theory", front / shape.front, 1, 0.1),
      near_to("height where it stops, share of theory", height / shape.height(0), 1, 0.1),
      at_most("motion of the front in the last quarter, share of its way", (front - front_before) / (front - edge),
              0.03),
  };
  result.plots.plots = {line_plot("Where it stops", "x (m)", "height (m)", {theory, surface}),
                        line_plot("Front", "time (s)", "x (m)", {fronts})};
  return result;
}

}  // namespace

ValidationCase bingham_slump_case() {
  return {"bingham_slump", "a block of mud that slumps and stops, against the balance of pressure and yield stress",
          false, run};
}

}  // namespace flowskin::tools
