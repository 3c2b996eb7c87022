// Particle shifting, for fluid that fills its space: it flows like a fluid, not like the lattice it began as; momentum
// and volume are kept; walls and even lattices are not disturbed.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/sph/test_meshes.h"

namespace flowskin::sph::shifting_test {
namespace {

constexpr int across = 20;
constexpr double spacing = 1.0 / across, thickness = 7 * spacing;

// Vortices [Taylor and Green 1937] of 1 m/s in a periodic box of 1 m, Reynolds number 100.
Vec3 vortex_field(const Vec3& p) {
  const double x = 2 * std::numbers::pi * p.x(), y = 2 * std::numbers::pi * p.y();
  return {-std::cos(x) * std::sin(y), std::sin(x) * std::cos(y), 0};
}

SimulationSetup vortices(double shifting) {
  SimulationSetup setup;
  setup.settings.spacing = spacing;
  setup.settings.viscosity = 0.01;
  setup.settings.gravity.setZero();
  setup.settings.max_speed = 1;
  setup.settings.support_radius = 3.5;
  setup.settings.density_method = DensityMethod::continuity;
  setup.settings.particle_shifting = shifting;
  setup.settings.background_pressure = shifting > 0 ? 0 : 1000;
  setup.settings.domain = {{0, 0, 0}, {1, 1, thickness}};
  setup.settings.periodic = {true, true, true};
  for (int i = 0; i < across; ++i) {
    for (int j = 0; j < across; ++j) {
      FluidBody column;
      column.block.min = spacing * Vec3(i, j, 0);
      column.block.max = column.block.min + Vec3(spacing, spacing, thickness);
      column.velocity = vortex_field(column.block.min + Vec3(0.5 * spacing, 0.5 * spacing, 0));
      setup.bodies.push_back(column);
    }
  }
  return setup;
}

// Share of the vortices in the flow.
double amplitude(const FluidState& state) {
  double sum = 0, norm = 0;
  for (std::size_t i = 0; i < state.ids.size(); ++i) {
    const Vec3 field = vortex_field(state.positions[i]);
    sum += field.dot(state.velocities[i]);
    norm += field.squaredNorm();
  }
  return sum / norm;
}

TEST(Shifting, VorticesDecayAsTheoryHasIt) {
  const double rate = 2 * 0.01 * std::pow(2 * std::numbers::pi, 2), end = 0.5 / rate;
  Solver shifted(vortices(1)), plain(vortices(0));
  const Vec3 momentum = shifted.momentum();
  shifted.advance_to(end);
  plain.advance_to(end);
  const FluidState state = shifted.state();
  // Coarse as this is, within a tenth of the theory; without shifting a third is missing.
  EXPECT_NEAR(amplitude(state) / std::exp(-0.5), 1, 0.1);
  EXPECT_LT(amplitude(plain.state()) / std::exp(-0.5), 0.8);
  // Of particles that move at about 1 m/s.
  const double mass = 1000 * thickness;
  EXPECT_LT((shifted.momentum() - momentum).norm(), 1e-6 * mass);
  double mean = 0;
  for (const double density : state.densities) mean += density / static_cast<double>(state.densities.size());
  EXPECT_NEAR(mean, 1000, 1e-3);
}

TEST(Shifting, LeavesALatticeBetweenWallsAlone) {
  SimulationSetup setup = block_setup(0.05, {0, 0, 0}, {0.4, 0.3, 0.2});
  setup.settings.gravity.setZero();
  setup.settings.density_method = DensityMethod::continuity;
  setup.settings.particle_shifting = 1;
  setup.settings.domain = {{0, -1, 0}, {0.4, 1, 0.2}};
  setup.settings.periodic = {true, false, true};
  setup.bodies[0].velocity = {1, 0, 0};
  setup.boundaries.push_back({sheet(1, 0), 1});
  setup.boundaries.push_back({sheet(1, 0.3), 1});
  Solver solver(setup);
  solver.advance_to(1);
  const FluidState state = solver.state();
  ASSERT_EQ(state.ids.size(), 8U * 6 * 4);
  for (std::size_t i = 0; i < state.ids.size(); ++i) {
    EXPECT_NEAR(state.positions[i].y(), state.rest_positions[i].y(), 0.01 * 0.05);
  }
}

TEST(Shifting, SaysWhereItDoesNotFit) {
  const auto message_of = [](const auto& change) -> std::string {
    SimulationSetup setup = block_setup(0.1, {0, 0, 0}, {0.5, 0.5, 0.5});
    setup.settings.density_method = DensityMethod::continuity;
    setup.settings.particle_shifting = 1;
    change(setup);
    try {
      const Solver solver(setup);
    } catch (const SettingsError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(message_of([](SimulationSetup&) {}), "no error");
  const auto method = [](SimulationSetup& s) { s.settings.density_method = DensityMethod::summation; };
  EXPECT_NE(message_of(method).find("continuity"), std::string::npos);
  EXPECT_NE(message_of([](SimulationSetup& s) { s.settings.xsph = 0.2; }).find("xsph"), std::string::npos);
  EXPECT_NE(message_of([](SimulationSetup& s) { s.settings.surface_tension = 1; }).find("surface"), std::string::npos);
  EXPECT_NE(message_of([](SimulationSetup& s) { s.sinks.emplace_back(); }).find("sinks"), std::string::npos);
  EXPECT_NE(message_of([](SimulationSetup& s) { s.settings.particle_shifting = 3; }).find("0 to 2"), std::string::npos);
}

}  // namespace
}  // namespace flowskin::sph::shifting_test
