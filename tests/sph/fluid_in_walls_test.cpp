// Fluid that would begin inside closed walls is left out, and nothing else is.
#include "sph/walls/fluid_in_walls.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sph/geometry/closed_parts.h"
#include "sph/geometry/mesh_inside.h"
#include "test_meshes.h"

namespace flowskin::sph::fluid_in_walls_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double spacing = 0.05;

/// A block of 8 x 8 x 8 particles on the plane y = 0, walls around or within it.
SimulationSetup block_and(const std::vector<Boundary>& walls) {
  SimulationSetup setup = block_setup(spacing, {-0.2, 0, -0.2}, {0.2, 0.4, 0.2});
  setup.boundaries = walls;
  return setup;
}

bool in_box(const Vec3& p, const Vec3& min, const Vec3& max) {
  return ((p - min).array() > 0).all() && ((max - p).array() > 0).all();
}

std::size_t count_in(const Solver& solver, const Vec3& min, const Vec3& max) {
  std::size_t count = 0;
  for (const Vec3& p : solver.state().positions) count += in_box(p, min, max);
  return count;
}

const Vec3 low{-0.11, 0.09, -0.11}, high{0.11, 0.31, 0.11};

Boundary named(TriangleMesh mesh) {
  Boundary wall{std::move(mesh), 0};
  wall.name = "solid.obj";
  return wall;
}

TEST(FluidInWalls, IsLeftOutAndCounted) {
  const Solver solver(block_and({named(closed_box(low, high))}));
  EXPECT_EQ(count_in(solver, low, high), 0U);
  EXPECT_GT(solver.particle_count(), 250U);
  EXPECT_THAT(solver.warnings(), ElementsAre(AllOf(HasSubstr("fluid body 1: "), HasSubstr(" of "),
                                                   HasSubstr("boundary 1 (solid.obj)"), HasSubstr("\"hollow\""))));
}

TEST(FluidInWalls, InsideOutSolidsAreSolid) {
  TriangleMesh inward = closed_box(low, high);
  for (auto& t : inward.triangles) std::swap(t[1], t[2]);
  EXPECT_EQ(count_in(Solver(block_and({named(inward)})), low, high), 0U);
}

TEST(FluidInWalls, HollowAndOpenWallsKeepTheirFluid) {
  Boundary hollow = named(closed_box(low, high));
  hollow.hollow = true;
  TriangleMesh cup = closed_box(low, high);
  cup.triangles.pop_back();
  for (const Boundary& wall : {hollow, named(cup)}) {
    const Solver solver(block_and({wall}));
    EXPECT_GT(count_in(solver, low, high), 20U);
    EXPECT_THAT(solver.warnings(), IsEmpty());
  }
}

TEST(FluidInWalls, OnAFlushWallNothingIsLeftOut) {
  const Solver solver(block_and({named(closed_box({-1, -0.2, -1}, {1, 0, 1}))}));
  EXPECT_EQ(solver.particle_count(), 512U);
  EXPECT_THAT(solver.warnings(), IsEmpty());
}

TEST(FluidInWalls, AClosedPartOfAnOpenMeshCounts) {
  TriangleMesh mesh = closed_box(low, high);
  add_quad(mesh, {-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1});
  EXPECT_EQ(count_in(Solver(block_and({named(mesh)})), low, high), 0U);
}

TEST(FluidInWalls, MovingWallsCountWhereTheyAreAtTheStart) {
  Boundary wall = named(closed_box(low - Vec3(0, 1, 0), high - Vec3(0, 1, 0)));
  wall.motion.keyframes = {{0, {0, 1, 0}, Vec3::Zero()}, {1, {0, 2, 0}, Vec3::Zero()}};
  EXPECT_EQ(count_in(Solver(block_and({wall})), low, high), 0U);
}

TEST(FluidInWalls, PeriodicImagesCount) {
  SimulationSetup setup = block_and({named(closed_box(low + Vec3(0.8, 0, 0), high + Vec3(0.8, 0, 0)))});
  setup.settings.domain = {{-0.4, -1, -0.4}, {0.4, 1, 0.4}};
  setup.settings.periodic = {true, false, false};
  EXPECT_EQ(count_in(Solver(setup), low, high), 0U);
}

TEST(FluidInWalls, NoFluidLeftIsAnError) {
  const SimulationSetup setup = block_and({named(closed_box({-1, -1, -1}, {1, 1, 1}))});
  try {
    const Solver solver(setup);
    FAIL();
  } catch (const SettingsError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("no fluid is left"), HasSubstr("512 of 512"), HasSubstr("solid.obj"),
                                    HasSubstr("\"hollow\": true")));
  }
}

Emitter jet_down(double height) {
  Emitter emitter;
  emitter.center = {0, height, 0};
  emitter.radius = 0.2;
  emitter.speed = 1;
  return emitter;
}

TEST(FluidInWalls, OfAnEmitterThePlacesInsideAreLeftOut) {
  SimulationSetup setup = block_and({named(closed_box({0, 0.8, -1}, {1, 1.2, 1}))});
  setup.emitters.push_back(jet_down(1));
  Solver solver(setup);
  EXPECT_THAT(solver.warnings(),
              ElementsAre(AllOf(HasSubstr("emitter 1: "), HasSubstr("of each layer"), HasSubstr("solid.obj"))));
  solver.advance_to(0.1);
  EXPECT_GT(count_in(solver, {-1, 0.8, -1}, {0, 1.2, 1}), 20U);
  EXPECT_EQ(count_in(solver, {0.01, 0.8, -1}, {1, 1.2, 1}), 0U);
}

TEST(FluidInWalls, AnEmitterFlushWithAWallPoursAwayFromIt) {
  for (const double top : {1.0, 1.2}) {
    SimulationSetup setup = block_and({named(closed_box({-1, top, -1}, {1, top + 0.2, 1}))});
    setup.emitters.push_back(jet_down(1));
    EXPECT_THAT(Solver(setup).warnings(), IsEmpty());
  }
}

// The other route: the winding number of mesh_inside, which asks that the mesh be closed and oriented.
TEST(ClosedParts, AgreeWithTheWindingNumber) {
  const TriangleMesh ball = sphere({0.1, 0.2, 0.3}, 0.5, 20);
  const ClosedParts parts(ball);
  ASSERT_FALSE(parts.empty());
  Random random(7);
  for (int k = 0; k < 5000; ++k) {
    const Vec3 p = Vec3(0.1, 0.2, 0.3) + 1.2 * (random.vector() - Vec3::Constant(0.5));
    EXPECT_EQ(parts.contains(p), is_inside(ball, p)) << p.transpose();
  }
}

TEST(ClosedParts, OverlappingShellsAreOne) {
  TriangleMesh both = closed_box({0, 0, 0}, {1, 1, 1});
  const TriangleMesh other = closed_box({0.5, 0.2, 0.2}, {1.5, 0.8, 0.8});
  const int first = static_cast<int>(both.positions.size());
  both.positions.insert(both.positions.end(), other.positions.begin(), other.positions.end());
  for (const auto& t : other.triangles) both.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  const ClosedParts parts(both);
  for (const double x : {0.1, 0.7, 1.2}) EXPECT_TRUE(parts.contains({x, 0.5, 0.5})) << x;
  EXPECT_FALSE(parts.contains({1.2, 0.1, 0.5}));
}

TEST(ClosedParts, MixedOrientationStillEncloses) {
  TriangleMesh box = closed_box({0, 0, 0}, {1, 1, 1});
  std::swap(box.triangles[3][0], box.triangles[3][1]);
  std::swap(box.triangles[8][0], box.triangles[8][1]);
  const ClosedParts parts(box);
  Random random(3);
  for (int k = 0; k < 500; ++k) {
    const Vec3 p = 1.4 * random.vector() - Vec3::Constant(0.2);
    EXPECT_EQ(parts.contains(p), in_box(p, Vec3::Zero(), Vec3::Ones())) << p.transpose();
  }
}

}  // namespace
}  // namespace flowskin::sph::fluid_in_walls_test
