// Viscosities that depend on the shear rate, and several fluids in one simulation.
#include "sph/viscosity/rheology.h"

#include <gtest/gtest.h>

#include "sph/walls/wall_kernel.h"
#include "tests/sph/test_meshes.h"

namespace flowskin::sph::rheology_test {
namespace {

Fluid herschel_bulkley(double consistency, double flow_index, double yield_stress) {
  Fluid fluid;
  fluid.name = "mud";
  fluid.viscosity = 0.5;
  fluid.rheology = {consistency, flow_index, yield_stress, 1000, 20};
  return fluid;
}

TEST(Rheology, ViscosityFollowsTheLaw) {
  Fluid newtonian;
  newtonian.viscosity = 0.3;
  EXPECT_EQ(viscosity_at(newtonian, 1000, 0), 0.3);
  EXPECT_EQ(viscosity_at(newtonian, 1000, 50), 0.3);

  const Fluid power = herschel_bulkley(100, 0.5, 0);
  EXPECT_NEAR(viscosity_at(power, 1000, 4), 0.1 * std::pow(4, -0.5), 1e-12);
  EXPECT_EQ(viscosity_at(power, 1000, 0), 20);  // the cap
  const Fluid thickening = herschel_bulkley(100, 2, 0);
  EXPECT_NEAR(viscosity_at(thickening, 1000, 3), 0.3, 1e-12);

  // Bingham: well above 1/m the stress is that of the ideal law; at rest it is finite.
  Fluid bingham = herschel_bulkley(0, 1, 80);
  EXPECT_NEAR(viscosity_at(bingham, 1000, 2), 0.5 + 0.08 / 2, 1e-9);
  bingham.rheology.max_viscosity = 1e9;
  EXPECT_NEAR(viscosity_at(bingham, 1000, 0), 0.5 + 0.08 * 1000, 1e-3);
  EXPECT_NEAR(viscosity_at(bingham, 1000, 1e-4), 0.5 + 0.08 * (1 - std::exp(-0.1)) / 1e-4, 1e-6);
}

// The shear rates of a lattice of particles in a linear flow.
std::vector<float> shear_rates(const Eigen::Matrix3d& gradient, bool on_wall, bool one_layer) {
  SolverSettings settings;
  settings.spacing = 0.1;
  settings.speed_of_sound = 10;
  const WallKernel wall = make_wall_kernel(settings);
  std::vector<FluidPack> packs;
  std::vector<Eigen::Vector3f> points, wall_points;
  std::vector<WallPack> walls;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < (one_layer ? 1 : 6); ++j) {
      for (int k = 0; k < 6; ++k) {
        const Vec3 x(0.1 * i, 0.1 * (j + 0.5), 0.1 * k), v = gradient * x;
        points.push_back(x.cast<float>());
        const Eigen::Vector3f u = v.cast<float>();
        packs.push_back({points.back().x(), points.back().y(), points.back().z(), u.x(), u.y(), u.z(), 0, 0});
      }
    }
  }
  for (int i = -10; on_wall && i < 30; ++i) {
    for (int k = -10; k < 30; ++k) {
      wall_points.emplace_back(0.045F * static_cast<float>(i), 0.0F, 0.045F * static_cast<float>(k));
      walls.push_back({wall_points.back().x(), 0, wall_points.back().z(), 0.1F, 1, {}});
    }
  }
  PointClusters clusters, wall_clusters;
  clusters.assign(points, 0.3F);
  wall_clusters.assign(wall_points, 0.3F);
  NeighborLists fluid_lists, wall_lists;
  fluid_lists.build(clusters, clusters, 0.2F);
  wall_lists.build(clusters, wall_clusters, 0.2F);
  const PairData data{packs, &clusters, &fluid_lists, walls, &wall_lists, 0, {}, {}, {}};
  std::vector<float> rates(packs.size());
  find_shear_rates(PairCoefficients(settings, wall), settings, data, rates);
  return rates;
}

TEST(Rheology, ShearRateIsExactInLinearFlowsUpToSurfacesAndWalls) {
  Eigen::Matrix3d shear = Eigen::Matrix3d::Zero(), spin = Eigen::Matrix3d::Zero(), stretch = Eigen::Matrix3d::Zero();
  shear(0, 1) = 3;  // u = 3 y: at rest on the wall y = 0
  spin(0, 1) = 2, spin(1, 0) = -2, spin(1, 2) = 1, spin(2, 1) = -1;
  stretch(0, 0) = 2, stretch(1, 1) = -1, stretch(2, 2) = -1;
  for (const bool on_wall : {false, true}) {
    for (const float rate : shear_rates(shear, on_wall, false)) EXPECT_NEAR(rate, 3, 0.02);
  }
  for (const float rate : shear_rates(spin, false, false)) EXPECT_NEAR(rate, 0, 0.02);
  for (const float rate : shear_rates(stretch, false, false)) EXPECT_NEAR(rate, std::sqrt(12), 0.03);
  // One layer of particles says nothing about the direction across it; the result is still a number.
  for (const float rate : shear_rates(shear, false, true)) EXPECT_NEAR(rate, 0, 1e-3);
}

SimulationSetup two_blocks() {
  SimulationSetup setup = block_setup(0.05, {0, 0, 0}, {0.3, 0.3, 0.3});
  FluidBody other = setup.bodies[0];
  other.block = {{0, 0.3, 0}, {0.3, 0.6, 0.3}};
  other.fluid = "thick";
  other.velocity = {0.5, 0, 0};
  setup.bodies.push_back(other);
  setup.settings.gravity.setZero();
  setup.fluids.resize(2);
  setup.fluids[0].name = "thin";
  setup.fluids[0].viscosity = 0.002;
  setup.fluids[1].name = "thick";
  setup.fluids[1].viscosity = 0.2;
  return setup;
}

TEST(Fluids, OneFluidNeedsNoArrays) {
  SimulationSetup setup = block_setup(0.05, {0, 0, 0}, {0.3, 0.3, 0.3});
  setup.fluids.push_back({"water", 1e-3, {}});
  const Solver solver(setup);
  EXPECT_TRUE(solver.state().fluids.empty());
  EXPECT_TRUE(solver.state().viscosities.empty());
  EXPECT_EQ(solver.settings().viscosity, 1e-3);
}

TEST(Fluids, TwoFluidsKeepMomentumAndTheirNames) {
  for (const auto how : {ViscositySolver::explicit_steps, ViscositySolver::implicit}) {
    SimulationSetup setup = two_blocks();
    setup.settings.viscosity_solver = how;
    Solver solver(setup);
    EXPECT_EQ(solver.settings().viscosity, 0.2);
    const Vec3 before = solver.momentum();
    solver.advance_to(0.05);
    EXPECT_LT((solver.momentum() - before).norm(), 2e-6 * before.norm());
    const FluidState state = solver.state();
    ASSERT_EQ(state.fluids.size(), state.ids.size());
    for (std::size_t i = 0; i < state.ids.size(); ++i) {
      EXPECT_EQ(state.fluids[i], state.rest_positions[i].y() > 0.3 ? 1 : 0);
      EXPECT_EQ(state.viscosities[i], state.fluids[i] ? 0.2F : 0.002F);
    }
  }
}

// Two layers that slide over each other: with the harmonic mean the interface moves at a speed between the two such
// that both feel the same stress. Thick fluid drags thin fluid along its boundary layer, and is hardly slowed itself.
TEST(Fluids, ThickFluidDragsThinFluid) {
  Solver solver(two_blocks());
  solver.advance_to(0.1);
  const FluidState state = solver.state();
  double thick = 0, thin = 0, count = 0;
  for (std::size_t i = 0; i < state.ids.size(); ++i) {
    (state.fluids[i] ? thick : thin) += state.velocities[i].x();
    count += 0.5;
  }
  EXPECT_GT(thick / count, 0.45);
  EXPECT_GT(thin / count, 0.005);
  EXPECT_LT(thin / count, 0.05);
}

TEST(Fluids, ImpossibleFluidsAreNamed) {
  const auto message = [](const SimulationSetup& setup) -> std::string {
    try {
      const Solver solver(setup);
      return "";
    } catch (const SettingsError& error) {
      return error.what();
    }
  };
  SimulationSetup setup = two_blocks();
  setup.bodies[1].fluid = "tick";
  EXPECT_NE(message(setup).find("fluid body 2: there is no fluid named \"tick\""), std::string::npos);
  setup = two_blocks();
  setup.fluids[1].rheology.flow_index = -1;
  setup.fluids[1].rheology.consistency = 3;
  EXPECT_NE(message(setup).find("fluid \"thick\": flow_index"), std::string::npos);
  setup = two_blocks();
  setup.settings.viscosity_form = ViscosityForm::morris;
  EXPECT_NE(message(setup).find("choose monaghan"), std::string::npos);
}

// A heap with a yield stress stops while it is still a heap; without one, it runs on.
TEST(Rheology, YieldStressKeepsAHeap) {
  double height[2];
  for (const double yield_stress : {0.0, 800.0}) {
    SimulationSetup setup = block_setup(0.05, {-0.15, 0, -0.15}, {0.15, 0.3, 0.15});
    setup.fluids.push_back(herschel_bulkley(30, 1, yield_stress));
    setup.settings.max_speed = 2;
    setup.boundaries.push_back({sheet(0.8, 0), 0});
    Solver solver(setup);
    solver.advance_to(0.5);
    double top = 0;
    for (const Vec3& p : solver.state().positions) top = std::max(top, p.y());
    height[yield_stress > 0] = top;
  }
  EXPECT_GT(height[1], 0.2);
  EXPECT_LT(height[0], 0.15);
}

}  // namespace
}  // namespace flowskin::sph::rheology_test
