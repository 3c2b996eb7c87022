// Walls far larger than what fluid can reach, and fluid where it cannot be.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <set>

#include "sph/geometry/clip.h"
#include "sph/walls/boundary_sampling.h"
#include "sph/walls/wall_reach.h"
#include "tests/sph/test_meshes.h"

namespace flowskin::sph::wall_reach_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string error_of(const SimulationSetup& setup) {
  try {
    Solver solver(setup);
  } catch (const SettingsError& error) {
    return error.what();
  }
  return "no error";
}

/// A small drop above the origin; the domain is optional.
SimulationSetup drop(bool with_domain) {
  SimulationSetup setup = block_setup(0.02, {-0.06, 0.1, -0.06}, {0.06, 0.2, 0.06});
  if (with_domain) setup.settings.domain = {{-0.3, -0.1, -0.3}, {0.3, 0.5, 0.3}};
  return setup;
}

TriangleMesh triangle(const Vec3& a, const Vec3& b, const Vec3& c) { return {{a, b, c}, {{0, 1, 2}}}; }

std::set<std::array<double, 3>> inside(const std::vector<Vec3>& points, const Box& box) {
  std::set<std::array<double, 3>> found;
  for (const Vec3& p : points)
    if (contains(box, p)) found.insert({p.x(), p.y(), p.z()});
  return found;
}

TEST(WallReach, TheEstimateIsNearTheNumberOfSamples) {
  for (const TriangleMesh& mesh : {sheet(1, 0), closed_box({0, 0, 0}, {1, 2, 0.5}), sphere({0, 0, 0}, 1, 20),
                                   triangle({0, 0, 0}, {10, 1e-9, 0}, {5, 0, 1e-9})}) {
    const double spacing = 0.05, samples = double(sample_surface(mesh, spacing).size());
    EXPECT_NEAR(estimated_samples(mesh, spacing, everywhere()) / samples, 1, 0.25);
  }
  EXPECT_EQ(estimated_samples(sheet(1, 0), 0.05, {{2, -1, -1}, {3, 1, 1}}), 0);
}

TEST(WallReach, SamplesInReachAreThoseOfTheWholeSurface) {
  const Box reach{{-0.5, -0.3, -0.4}, {0.6, 0.8, 0.5}}, well_inside{{-0.3, -0.1, -0.2}, {0.4, 0.6, 0.3}};
  for (const TriangleMesh& mesh :
       {sheet(4, 0.1), closed_box({-0.2, -3, -0.1}, {5, 2, 0.2}), triangle({-3, -2, -3}, {4, 1, 2}, {-2, 3, 4})}) {
    const std::vector<Vec3> whole = sample_surface(mesh, 0.03), cut = sample_surface(mesh, 0.03, {}, reach);
    EXPECT_LT(cut.size(), whole.size() / 2);
    EXPECT_EQ(inside(cut, reach).size(), cut.size());
    EXPECT_FALSE(inside(whole, well_inside).empty());
    EXPECT_EQ(inside(cut, well_inside), inside(whole, well_inside));
  }
  // A box around all of it changes nothing, not even the order.
  EXPECT_EQ(sample_surface(sheet(1, 0), 0.03, {}, {{-9, -9, -9}, {9, 9, 9}}), sample_surface(sheet(1, 0), 0.03));
}

TEST(WallReach, WallsAsLargeAsTheWorldHoldFluidInTheDomain) {
  const auto start = std::chrono::steady_clock::now();
  std::size_t small_count = 0;
  for (const double half : {2.0, 500.0, 1e6}) {
    SimulationSetup setup = drop(true);
    setup.settings.max_speed = 2;
    setup.boundaries.push_back({sheet(half, 0), 0});
    Solver solver(setup);
    solver.advance_to(0.25);
    for (const Vec3& p : solver.state().positions) EXPECT_GT(p.y(), 0);
    if (small_count == 0) small_count = solver.boundary_particle_count();
    EXPECT_NEAR(double(solver.boundary_particle_count()), double(small_count), 0.02 * double(small_count));
  }
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
}

TEST(WallReach, TooManyWallParticlesAreRefusedWithTheNumber) {
  SimulationSetup setup = drop(false);
  setup.boundaries.push_back({sheet(500, 0), 0});
  EXPECT_THAT(error_of(setup), AllOf(HasSubstr("boundary 1"), HasSubstr("1.571e+10"), HasSubstr("0.02 m"),
                                     HasSubstr("simulation.domain"), HasSubstr("spacing")));
  // A box with a vertex that strays, and one that is a mere spike.
  setup.boundaries = {{sheet(0.2, 0), 0}, {closed_box({0, 0, 0}, {1, 1, 1}), 0}};
  setup.boundaries[1].mesh.positions[6] = {1e7, 3e7, -2e7};
  EXPECT_THAT(error_of(setup), AllOf(HasSubstr("boundary 2"), HasSubstr("stray")));
  setup.boundaries[1].mesh = triangle({0, 0, 0}, {0, 0, 0}, {1e8, 0, 0});
  EXPECT_THAT(error_of(setup), HasSubstr("boundary 2"));
  for (const double far : {1e10, 1e30, 1e300}) {
    setup.boundaries[1].mesh = triangle({0, 0, 0}, {1, 0, 0}, {0, far, 0});
    EXPECT_THAT(error_of(setup), AllOf(HasSubstr("boundary 2"), HasSubstr("stray")));
  }
  // Walls that move are sampled whole; each by itself would be few enough.
  setup = drop(true);
  for (int k = 0; k < 2; ++k) {
    setup.boundaries.push_back({sheet(11, 0), 0});
    setup.boundaries.back().motion.keyframes = {{0, {0, 0, 0}, {0, 0, 0}}, {1, {0, 0.1, 0}, {0, 0, 0}}};
  }
  EXPECT_THAT(error_of(setup), HasSubstr("boundary 2"));
}

TEST(WallReach, LongThinTrianglesAreWalkedAlongOnly) {
  const auto start = std::chrono::steady_clock::now();
  const std::vector<Vec3> samples = sample_surface(triangle({0, 0, 0}, {700, 700, 0}, {700.002, 700, 0}), 0.02);
  EXPECT_NEAR(double(samples.size()), 49500, 1000);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

TEST(WallReach, BodiesAndEmittersOfAbsurdSizeAreRefused) {
  SimulationSetup setup = drop(false);
  FluidBody body;
  body.shape = FluidBody::Shape::mesh;
  body.mesh = closed_box({0, 1, 0}, {0.2, 1.2, 0.2});
  body.mesh.positions[6] = {0.2, 1e6, 1e6};
  setup.bodies.push_back(body);
  EXPECT_THAT(error_of(setup), AllOf(HasSubstr("fluid body 2"), HasSubstr("stray"), HasSubstr("0.02 m")));
  setup = drop(false);
  Emitter emitter;
  emitter.speed = 1;
  emitter.radius = 1e5;
  setup.emitters = {emitter};
  EXPECT_THAT(error_of(setup), AllOf(HasSubstr("emitter 1"), HasSubstr("at most 1e+07")));
  setup.emitters[0].shape = Emitter::Shape::rectangle;
  setup.emitters[0].width = setup.emitters[0].height = 1e9;
  EXPECT_THAT(error_of(setup), HasSubstr("emitter 1"));
  setup.emitters[0].shape = Emitter::Shape::mesh;
  setup.emitters[0].mesh = sheet(1e6, 0);
  EXPECT_THAT(error_of(setup), HasSubstr("emitter 1"));
}

TEST(Domain, FluidWhollyOutsideIsAnErrorThatNamesIt) {
  SimulationSetup setup = drop(true);
  FluidBody ball;
  ball.shape = FluidBody::Shape::ball;
  ball.radius = 0.05;
  ball.center = {0, 3, 0};
  setup.bodies.push_back(ball);
  EXPECT_THAT(error_of(setup), AllOf(HasSubstr("fluid body 2"), HasSubstr("outside the domain")));
  setup.bodies.pop_back();
  Emitter emitter;
  emitter.center = {0, 0.3, 2};
  emitter.radius = 0.05;
  emitter.speed = 1;
  setup.emitters = {emitter};
  EXPECT_THAT(error_of(setup), AllOf(HasSubstr("emitter 1"), HasSubstr("outside the domain")));
  // Along axes without ends fluid may be anywhere.
  setup.settings.domain.min.z() = setup.settings.domain.max.z() = 0;
  EXPECT_EQ(error_of(setup), "no error");
}

TEST(Domain, FluidPartlyOutsideIsWarnedOf) {
  SimulationSetup setup = drop(true);
  EXPECT_THAT(Solver(setup).warnings(), IsEmpty());
  setup.settings.domain.max.y() = 0.16;
  EXPECT_THAT(Solver(setup).warnings(),
              ElementsAre(AllOf(HasSubstr("fluid body 1"), HasSubstr("72 of 180 particles"))));
}

TEST(Domain, FluidTooFarFromTheRestForSinglePrecisionIsRefused) {
  SimulationSetup setup = drop(false);
  FluidBody far = setup.bodies[0];
  far.block.min.x() += 1e5;
  far.block.max.x() += 1e5;
  setup.bodies.push_back(far);
  EXPECT_THAT(error_of(setup), AllOf(HasSubstr("fluid body 1"), HasSubstr("5e+04 m"), HasSubstr("2e+04 m")));
  setup.bodies.erase(setup.bodies.begin());  // alone it is in the middle
  EXPECT_EQ(error_of(setup), "no error");
}

TEST(Messages, NumbersHaveSignificantDigits) {
  SimulationSetup setup = drop(false);
  setup.settings.spacing = 1e-9;
  setup.bodies[0].shape = FluidBody::Shape::ball;
  setup.bodies[0].radius = 1e-13;
  EXPECT_THAT(error_of(setup), HasSubstr("the spacing of 1e-09 m"));
}

}  // namespace
}  // namespace flowskin::sph::wall_reach_test
