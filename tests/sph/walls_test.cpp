// Fluid at walls: they hold, and fluid at rest on them has the right density.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/sph/test_meshes.h"

namespace flowskin::sph::walls_test {
namespace {

TEST(Walls, HydrostaticBlockSettles) {
  SimulationSetup setup = block_setup(0.025, {0, 0, 0}, {0.25, 0.25, 0.25});
  setup.settings.viscosity = 0.01;
  setup.boundaries.push_back(tank(closed_box({0, 0, 0}, {0.25, 0.5, 0.25}), 0));
  Solver solver(setup);
  EXPECT_EQ(solver.particle_count(), 1000U);
  const double height = solver.energy().potential;
  solver.advance_to(1.5);
  const FluidState state = solver.state();
  double mean = 0, worst = 0, top = 0;
  for (std::size_t i = 0; i < state.ids.size(); ++i) {
    const double error = std::abs(state.densities[i] / 1000 - 1);
    mean += error / static_cast<double>(state.ids.size());
    worst = std::max(worst, error);
    top = std::max(top, state.positions[i].y());
    EXPECT_TRUE((state.positions[i].array() > 0).all());
    EXPECT_TRUE((state.positions[i].array() < Eigen::Array3d(0.25, 0.5, 0.25)).all());
  }
  EXPECT_LT(mean, 0.01);
  EXPECT_LT(worst, 0.03);
  EXPECT_EQ(solver.statistics().wall_crossings, 0U);
  // It stands as high as it did, within a third of a spacing, and has come to rest.
  EXPECT_NEAR(solver.energy().potential / height, 1, 0.03);
  EXPECT_NEAR(top, 0.2375, 0.02);
  EXPECT_LT(solver.energy().kinetic, 1e-3 * height);
}

TEST(Walls, PressureAtTheBottomCarriesTheWeight) {
  // Tait: the compression at depth d is g d / c^2 to first order.
  SimulationSetup setup = block_setup(0.025, {0, 0, 0}, {0.25, 0.5, 0.25});
  setup.settings.viscosity = 0.02;
  setup.boundaries.push_back(tank(closed_box({0, 0, 0}, {0.25, 0.7, 0.25}), 1));
  Solver solver(setup);
  const double c = solver.settings().speed_of_sound;
  double low = 0, low_count = 0;
  for (int k = 0; k < 60; ++k) {  // mean over several periods of the sound that the sudden weight makes
    solver.advance_to(0.3 + 0.007 * k);
    const FluidState state = solver.state();
    for (std::size_t i = 0; i < state.ids.size(); ++i) {
      if (std::abs(state.positions[i].y() - 0.1) > 0.05) continue;
      low += state.densities[i] / 1000 - 1;
      ++low_count;
    }
  }
  const double wanted = 9.81 * 0.39 / (c * c);
  EXPECT_NEAR(low / low_count, wanted, 0.15 * wanted);
}

// Shoots a small block at a wall at the fastest speed that the set-up is made for.
struct Shot {
  const char* name;
  TriangleMesh wall;
  Vec3 velocity;
};

std::vector<Shot> shots() {
  TriangleMesh wedge;  // two plates that meet in an edge pointing up
  add_quad(wedge, {0, 0, -0.5}, {-0.5, -0.5, -0.5}, {-0.5, -0.5, 0.5}, {0, 0, 0.5});
  add_quad(wedge, {0, 0, -0.5}, {0, 0, 0.5}, {0.5, -0.5, 0.5}, {0.5, -0.5, -0.5});
  return {{"plate", sheet(0.6, 0), {0, -4, 0}},
          {"plate, sliding", sheet(1.5, 0), {4, -3, 0}},
          {"edge", wedge, {0, -4, 0}},
          {"corner of a box", closed_box({0, -0.6, -0.6}, {0.6, 0, 0}), {1.5, -3.5, -1.5}}};
}

TEST(Walls, NothingPassesAWall) {
  for (const Shot& shot : shots()) {
    SimulationSetup setup = block_setup(0.03, {-0.12, 0.05, -0.12}, {0.12, 0.3, 0.12});
    setup.bodies[0].velocity = shot.velocity;
    setup.settings.gravity.setZero();
    setup.settings.viscosity = 0.001;
    setup.boundaries.push_back({shot.wall, 0});
    Solver solver(setup);
    solver.advance_to(0.25);
    const FluidState state = solver.state();
    for (std::size_t i = 0; i < state.ids.size(); ++i) {
      const Vec3& p = state.positions[i];
      if (std::string(shot.name).rfind("plate", 0) == 0) {
        EXPECT_TRUE(p.y() > 0 || std::max(std::abs(p.x()), std::abs(p.z())) > 0.6) << shot.name;
      } else if (shot.name == std::string("edge")) {
        EXPECT_TRUE(p.y() > -std::abs(p.x()) || std::max(std::abs(p.x()), std::abs(p.z())) > 0.5) << shot.name;
      } else {
        EXPECT_FALSE(p.x() > 0 && p.x() < 0.6 && p.y() < 0 && p.y() > -0.6 && p.z() < 0 && p.z() > -0.6) << shot.name;
      }
    }
  }
}

TEST(Walls, BackstopHoldsWhatPressureCannot) {
  // Twenty times faster than the set-up is made for, with a step that takes particles half a spacing at once.
  SimulationSetup setup = block_setup(0.03, {-0.06, 0.05, -0.06}, {0.06, 0.17, 0.06});
  setup.bodies[0].velocity = {0, -4, 0};
  setup.settings.gravity.setZero();
  setup.settings.speed_of_sound = 4.5;
  setup.settings.acoustic_cfl = 1.0;
  setup.boundaries.push_back({sheet(1, 0), 0});
  Solver solver(setup);
  try {
    solver.advance_to(0.1);
  } catch (const BlowUpError&) {
    // That fluid may well blow up; it must not pass the wall before.
  }
  for (const Vec3& p : solver.state().positions) EXPECT_GT(p.y(), 0);
}

TEST(Walls, ThinWallSeparatesFluids) {
  SimulationSetup setup = block_setup(0.03, {-0.15, 0, -0.15}, {0.15, 0.15, 0.15});
  FluidBody below;
  below.block = {{-0.15, -0.15, -0.15}, {0.15, 0, 0.15}};
  below.velocity = {0, 1, 0};
  setup.bodies.push_back(below);
  setup.settings.viscosity = 0.005;
  setup.boundaries.push_back({sheet(0.6, 0), 0.5});
  Solver solver(setup);
  solver.advance_to(0.15);
  const FluidState state = solver.state();
  for (std::size_t i = 0; i < state.ids.size(); ++i) {
    const Vec3& p = state.positions[i];
    if (std::max(std::abs(p.x()), std::abs(p.z())) > 0.55) continue;
    EXPECT_EQ(p.y() > 0, state.rest_positions[i].y() > 0);
  }
  EXPECT_EQ(solver.statistics().wall_crossings, 0U);
}

TEST(Walls, ViscousBodyFlowsDownSteps) {
  SimulationSetup setup = block_setup(0.04, {-0.2, 0.35, -0.2}, {0.16, 0.71, 0.2});
  setup.settings.viscosity = 0.03;
  TriangleMesh steps;
  add_quad(steps, {-0.6, 0.3, -0.6}, {-0.6, 0.3, 0.6}, {0, 0.3, 0.6}, {0, 0.3, -0.6});
  add_quad(steps, {0, 0.3, -0.6}, {0, 0.3, 0.6}, {0, 0.15, 0.6}, {0, 0.15, -0.6});
  add_quad(steps, {0, 0.15, -0.6}, {0, 0.15, 0.6}, {0.25, 0.15, 0.6}, {0.25, 0.15, -0.6});
  add_quad(steps, {0.25, 0.15, -0.6}, {0.25, 0.15, 0.6}, {0.25, 0, 0.6}, {0.25, 0, -0.6});
  add_quad(steps, {0.25, 0, -0.6}, {0.25, 0, 0.6}, {1, 0, 0.6}, {1, 0, -0.6});
  setup.boundaries.push_back({steps, 0});
  setup.settings.domain = {{-1, -0.5, -1}, {1.5, 2, 1}};
  Solver solver(setup);
  const auto count = solver.particle_count();
  solver.advance_to(1.5);
  EXPECT_EQ(solver.statistics().wall_crossings, 0U);
  EXPECT_EQ(solver.particle_count() + solver.statistics().left_domain, count);
  double lowest = 1, worst = 0;
  const FluidState state = solver.state();
  for (std::size_t i = 0; i < state.ids.size(); ++i) {
    const Vec3& p = state.positions[i];
    if (std::abs(p.z()) > 0.6) continue;
    const double floor = p.x() < -0.6 ? -1 : p.x() < 0 ? 0.3 : p.x() < 0.25 ? 0.15 : p.x() < 1 ? 0 : -1;
    EXPECT_GT(p.y(), floor);
    lowest = std::min(lowest, p.y());
    worst = std::max(worst, std::abs(state.densities[i] / 1000 - 1));
  }
  EXPECT_LT(lowest, 0.14);
  EXPECT_LT(worst, 0.03);
}

}  // namespace
}  // namespace flowskin::sph::walls_test
