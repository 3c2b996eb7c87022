// Walls without thickness, and thin plates: fluid on one side does not feel fluid on the other.
#include "sph/walls/thin_walls.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>

#include "tests/sph/test_meshes.h"

namespace flowskin::sph::thin_walls_test {
namespace {

constexpr double spacing = 0.03, reach = 2.5 * spacing;

bool sees(const TriangleMesh& mesh, const Vec3& a, const Vec3& b) {
  const ThinWalls walls({mesh}, WallGuard({mesh}, 2 * spacing), spacing, reach, {});
  if (walls.empty() || !walls.near(a)) return true;
  std::vector<std::uint8_t> hidden(1), back(1);
  walls.hide(std::span(&a, 1), std::span(&b, 1), hidden);
  walls.hide(std::span(&b, 1), std::span(&a, 1), back);
  EXPECT_EQ(hidden, back);
  return hidden[0] == 0;
}

TEST(ThinWalls, HideWhatIsBehindASheet) {
  const TriangleMesh wall = sheet(0.3, 0);
  EXPECT_FALSE(sees(wall, {0.1, 0.01, 0.05}, {0.11, -0.01, 0.05}));
  EXPECT_TRUE(sees(wall, {0.1, 0.01, 0.05}, {0.11, 0.02, 0.05}));
  // Straight through the diagonal that its two triangles share, and through a corner.
  EXPECT_FALSE(sees(wall, {0.1, 0.01, 0.1}, {0.1, -0.01, 0.1}));
  EXPECT_FALSE(sees(wall, {0, 0.02, 0}, {0, -0.02, 0}));
  EXPECT_FALSE(sees(wall, {0.3, 0.02, 0.3}, {0.3, -0.02, 0.3}));
  // Past its rim.
  EXPECT_FALSE(sees(wall, {0.295, 0.02, 0}, {0.295, -0.02, 0}));
  EXPECT_TRUE(sees(wall, {0.305, 0.02, 0}, {0.305, -0.02, 0}));
  EXPECT_TRUE(sees(wall, {0.29, 0.02, 0}, {0.33, -0.02, 0}));
}

TEST(ThinWalls, CornersAreNotInTheWay) {
  // An open surface with an edge along z, bent by the angle: the line from one plate to the other cuts the edge off.
  const auto bent = [](double degrees) {
    TriangleMesh mesh;
    const Vec3 side(-0.3 * std::cos(degrees * M_PI / 180), -0.3 * std::sin(degrees * M_PI / 180), 0), z(0, 0, 0.3);
    add_quad(mesh, Vec3(-0.3, 0, 0) - z, Vec3(-0.3, 0, 0) + z, z, -z);
    add_quad(mesh, -z, z, side + z, side - z);
    return mesh;
  };
  const Vec3 above(-0.02, 0.01, 0.001);
  EXPECT_TRUE(sees(bent(90), above, {0.01, -0.02, 0}));
  EXPECT_TRUE(sees(bent(90), above, {0.01, 0.02, 0}));
  EXPECT_FALSE(sees(bent(90), above, {-0.01, -0.02, 0}));
  EXPECT_FALSE(sees(bent(30), above, {-0.02, -0.03, 0}));  // in through one plate, out through the other
}

TEST(ThinWalls, PlatesAreThinAndBlocksAreNot) {
  EXPECT_FALSE(sees(closed_box({-0.3, -0.01, -0.3}, {0.3, 0.01, 0.3}), {0.1, 0.02, 0}, {0.1, -0.02, 0.02}));
  const TriangleMesh block = closed_box({-0.3, -0.3, -0.3}, {0.3, 0.3, 0.3});
  EXPECT_TRUE(ThinWalls({block}, WallGuard({block}, 2 * spacing), spacing, reach, {}).empty());
}

struct Case {
  std::string name;
  std::function<void(SimulationSetup&)> change;
};

// A tank with a sheet across the middle, which may move; fluid on the right side, and, if wanted, more and faster
// fluid on the left side.
SimulationSetup divided_tank(const Case& which, bool left_too) {
  SimulationSetup setup;
  setup.settings.spacing = spacing;
  setup.settings.viscosity = 0.01;
  setup.settings.max_speed = 3;
  setup.settings.max_time_step = 2e-4;  // the limits would not be the same with and without the left side
  FluidBody right;
  right.block = {{0, 0, -0.09}, {0.15, 0.12, 0.09}};
  setup.bodies.push_back(right);
  if (left_too) {
    FluidBody left;
    left.block = {{-0.15, 0, -0.09}, {0, 0.24, 0.09}};
    left.velocity = {0, 0.5, 0.3};
    setup.bodies.push_back(left);
  }
  setup.boundaries.push_back(tank(closed_box({-0.15, 0, -0.09}, {0.15, 0.4, 0.09}), 0));
  TriangleMesh partition;
  add_quad(partition, {0, 0, -0.09}, {0, 0.4, -0.09}, {0, 0.4, 0.09}, {0, 0, 0.09});
  setup.boundaries.push_back({partition, 0});
  which.change(setup);
  return setup;
}

class DividedTank : public testing::TestWithParam<Case> {};

TEST_P(DividedTank, OneSideDoesNotFeelTheOther) {
  Solver both(divided_tank(GetParam(), true)), alone(divided_tank(GetParam(), false));
  const double time = 0.1;
  both.advance_to(time);
  alone.advance_to(time);
  const FluidState a = both.state(), b = alone.state();
  // Particles are told apart by where they began; both runs have those of the right side.
  const auto key = [](const Vec3& p) { return std::array{p.x(), p.y(), p.z()}; };
  std::map<std::array<double, 3>, std::size_t> places;
  for (std::size_t i = 0; i < a.ids.size(); ++i) places[key(a.rest_positions[i])] = i;
  double moved = 0, worst = 0, worst_density = 0;
  for (std::size_t i = 0; i < b.ids.size(); ++i) {
    const auto found = places.find(key(b.rest_positions[i]));
    ASSERT_NE(found, places.end());
    const std::size_t k = found->second;
    worst = std::max(worst, (a.positions[k] - b.positions[i]).norm());
    worst_density = std::max(worst_density, std::abs(a.densities[k] - b.densities[i]) / 1000);
    moved = std::max(moved, (b.positions[i] - b.rest_positions[i]).norm());
  }
  EXPECT_GT(a.ids.size(), 2 * b.ids.size());
  EXPECT_GT(moved, 0.02 * spacing);
  // Nothing but the order of the sums is different.
  EXPECT_LT(worst, 1e-3 * spacing);
  EXPECT_LT(worst_density, 1e-4);
  RecordProperty("displacement_ppm_of_spacing", static_cast<int>(1e6 * worst / spacing));
}

INSTANTIATE_TEST_SUITE_P(
    Features, DividedTank,
    testing::Values(
        Case{"Plain", [](SimulationSetup&) {}},
        Case{"ImplicitViscosity",
             [](SimulationSetup& s) {
               s.settings.viscosity = 0.2;
               s.settings.viscosity_solver = ViscositySolver::implicit;
               s.settings.viscosity_tolerance = 1e-6;
             }},
        Case{"ContinuityMorrisXsph",
             [](SimulationSetup& s) {
               s.settings.density_method = DensityMethod::continuity;
               s.settings.viscosity_form = ViscosityForm::morris;
               s.settings.xsph = 0.2;
             }},
        Case{"SurfaceTension", [](SimulationSetup& s) { s.settings.surface_tension = 1; }},
        Case{"ShearDependentViscosity",
             [](SimulationSetup& s) {
               Fluid paint;
               paint.name = "paint";
               paint.rheology.consistency = 5;
               paint.rheology.flow_index = 0.7;
               s.fluids.push_back(paint);
             }},
        Case{"Periodic",
             [](SimulationSetup& s) {
               s.settings.domain = {{0, 0, -0.09}, {0, 0, 0.09}};
               s.settings.periodic = {false, false, true};
             }},
        Case{"MovingPartition",
             [](SimulationSetup& s) {
               s.boundaries[1].motion.keyframes = {{0, Vec3::Zero(), Vec3::Zero()}, {1, Vec3(0.2, 0, 0), Vec3::Zero()}};
             }}),
    [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace flowskin::sph::thin_walls_test
