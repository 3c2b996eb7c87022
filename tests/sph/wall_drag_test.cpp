// Skin friction of boundary layers thinner than a particle: a slab that slides on a plate against its law.
#include <gtest/gtest.h>

#include "sph/walls/wall_drag.h"
#include "tests/sph/test_meshes.h"

namespace flowskin::sph::wall_drag_test {
namespace {

constexpr double height = 0.04, speed = 1, time = 0.05, water = 1e-6;

/// An endless slab of water on a plate.
SimulationSetup sliding_slab(int layers, double drag) {
  const double spacing = height / layers, length = 4 * spacing;
  SimulationSetup setup = block_setup(spacing, {0, 0, 0}, {length, height, length});
  setup.bodies[0].velocity = {speed, 0, 0};
  setup.settings.viscosity = water;
  setup.settings.wall_drag = drag;
  setup.settings.max_speed = 2;
  setup.settings.domain = {{0, 0, 0}, {length, 0, length}};
  setup.settings.periodic = {true, false, true};
  setup.boundaries.push_back({sheet(1, 0), 0});
  return setup;
}

double momentum_per_area(const SimulationSetup& setup, Vec3& change) {
  Solver solver(setup);
  const Vec3 before = solver.momentum();
  solver.advance_to(time);
  const double length = setup.settings.domain.max.x();
  change = (solver.momentum() - before) / (1000 * length * length);
  return -change.x();
}

double lost(int layers, double drag) {
  Vec3 change;
  return momentum_per_area(sliding_slab(layers, drag), change);
}

TEST(WallDrag, LawOfTheBoundaryLayer) {
  // 0.4437 rho u^2 / sqrt(Re) and 0.0296 rho u^2 / Re^(1/5), Re = u^2 t / nu.
  EXPECT_NEAR(boundary_layer_stress(2, 0.01, 1e-6), 0.4437 * 4 / 200, 1e-12);
  EXPECT_NEAR(boundary_layer_stress(10, 1, 1e-6), 2.96 / std::pow(1e8, 0.2), 1e-12);
}

TEST(WallDrag, SlabLosesTheMomentumOfTheLawAtAnySpacing) {
  // Integral of 0.4437 u sqrt(nu / t): 2.8e-4 of the 0.04 m^2/s that it has, while its own friction would take
  // 2 nu u t / spacing, 1e-5 to 2e-5.
  const double wanted = 2 * 0.4437 * speed * std::sqrt(water * time);
  for (const int layers : {4, 6, 8}) EXPECT_NEAR(lost(layers, 1) / wanted, 1, 0.06) << layers << " layers";
  EXPECT_LT(lost(6, 0), 0.2 * wanted);
  EXPECT_NEAR((lost(6, 0.5) - lost(6, 0)) / (lost(6, 1) - lost(6, 0)), 0.5, 0.02);
}

TEST(WallDrag, ActsAgainstTheMotionRelativeToTheWall) {
  const double straight = lost(6, 1);
  Vec3 change;
  SimulationSetup setup = sliding_slab(6, 1);
  setup.bodies[0].velocity = {0.6, 0, 0.8};
  momentum_per_area(setup, change);
  EXPECT_NEAR(-change.x() / straight, 0.6, 0.05);
  EXPECT_NEAR(-change.z() / straight, 0.8, 0.05);
  // A belt that runs under fluid at rest takes it along as much; one that runs with it does nothing.
  setup.bodies[0].velocity = Vec3::Zero();
  setup.boundaries[0].surface_velocity = {-speed, 0, 0};
  EXPECT_NEAR(momentum_per_area(setup, change) / straight, 1, 0.08);  // always over the same samples: 0.94
  setup.bodies[0].velocity = {-speed, 0, 0};
  EXPECT_NEAR(momentum_per_area(setup, change) / straight, 0, 0.05);
  // A wall without friction has no boundary layer.
  setup.boundaries[0].slip = 1;
  setup.boundaries[0].surface_velocity = Vec3::Zero();
  EXPECT_NEAR(momentum_per_area(setup, change) / straight, 0, 0.05);
}

TEST(WallDrag, FloorThatDriesForgets) {
  // The age of a place counts from when it was wetted last: a slab that is lifted off and put back feels a fresh wall.
  SimulationSetup setup = sliding_slab(4, 1);
  setup.settings.gravity = Vec3::Zero();
  Boundary& floor = setup.boundaries[0];
  floor.motion.keyframes = {
      {0.02, Vec3::Zero(), Vec3::Zero()}, {0.024, {0, -0.02, 0}, Vec3::Zero()}, {0.028, Vec3::Zero(), Vec3::Zero()}};
  Vec3 change;
  const double first = 2 * 0.4437 * speed * std::sqrt(water * 0.02), then = 2 * 0.4437 * std::sqrt(water * 0.023);
  EXPECT_NEAR(momentum_per_area(setup, change) / (first + then), 1, 0.12);
}

TEST(WallDrag, WrongShareIsRefused) {
  SimulationSetup setup = sliding_slab(4, 1.5);
  EXPECT_THROW(Solver{setup}, SettingsError);
}

}  // namespace
}  // namespace flowskin::sph::wall_drag_test
