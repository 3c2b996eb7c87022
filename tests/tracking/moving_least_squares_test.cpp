// The particles' flow around a point: exact for linear flows, defined for every arrangement of particles.
#include "tracking/velocity/moving_least_squares.h"
#include "tracking/field/metaballs/metaball_field.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <vector>

#include "tests/tracking/field_test_bodies.h"

namespace flowskin::tracking::moving_least_squares_test {
namespace {

using test::lattice;
using test::Random;
using test::velocities_of;

constexpr double spacing = 1.0 / 7;

Mat3 random_matrix(Random& random) {
  Mat3 m;
  for (int column = 0; column < 3; ++column) m.col(column) = random.vector();
  return m;
}

std::vector<Vec3> ball_particles() {
  return lattice(spacing, 5, 0.25, 71, [](const Vec3& x) { return x.norm() < 4.35 * spacing; });
}

MetaballField moving(const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities, double radius) {
  return {positions, velocities, {radius, 0.5, 1}};
}

bool is_finite(const LocalFlow& flow) {
  return flow.velocity.allFinite() && flow.gradient.allFinite() && std::isfinite(flow.misfit);
}

TEST(MovingLeastSquares, IsExactForEveryLinearFlow) {
  Random random(72);
  const std::vector<Vec3> particles = ball_particles();
  for (int trial = 0; trial < 20; ++trial) {
    const Mat3 gradient = random_matrix(random);
    const Vec3 constant = random.vector();
    const auto flow = [&](const Vec3& x) { return Vec3(constant + gradient * x); };
    const MetaballField field = moving(particles, velocities_of(particles, flow), 2.5 * spacing);
    for (int i = 0; i < 50; ++i) {
      const Vec3 x = 4.8 * spacing * random.vector().normalized() * std::abs(random.symmetric());
      const LocalFlow found = local_flow(field, x);
      ASSERT_TRUE(found.defined);
      EXPECT_LT((found.velocity - flow(x)).norm(), 1e-10 * (constant.norm() + gradient.norm()));
      EXPECT_LT((found.gradient - gradient).norm(), 1e-9 * (constant.norm() / spacing + gradient.norm()));
      EXPECT_LT(found.misfit, 1e-9);
    }
  }
}

TEST(MovingLeastSquares, MisfitIsTheShareThatNoLinearFlowExplains) {
  const std::vector<Vec3> particles = ball_particles();
  Random random(73);
  std::vector<Vec3> velocities;
  for (std::size_t i = 0; i < particles.size(); ++i) velocities.push_back(random.vector());
  const double of_noise = local_flow(moving(particles, velocities, 2.5 * spacing), Vec3::Zero()).misfit;
  EXPECT_GT(of_noise, 0.7);
  EXPECT_LE(of_noise, 1);
  // It is the spread of the velocities that counts: a common velocity changes nothing, a linear flow does.
  std::vector<Vec3> shifted, sheared;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    shifted.push_back(Vec3(10, 0, 0) + velocities[i]);
    sheared.push_back(Vec3(100 / spacing * particles[i].y(), 0, 0) + velocities[i]);
  }
  EXPECT_NEAR(local_flow(moving(particles, shifted, 2.5 * spacing), Vec3::Zero()).misfit, of_noise, 1e-9);
  const LocalFlow shear = local_flow(moving(particles, sheared, 2.5 * spacing), Vec3::Zero());
  EXPECT_LT(shear.misfit, 0.02);
  // The gradient's error is what the noise of the velocities leads to expect.
  const double error2 = (shear.gradient - Vec3::UnitX() * (100 / spacing) * Vec3::UnitY().transpose()).squaredNorm();
  EXPECT_GT(error2, 0.1 * shear.gradient_error2);
  EXPECT_LT(error2, 5 * shear.gradient_error2);
}

TEST(MovingLeastSquares, LeavesOutTheGradientWhereParticlesDoNotSpread) {
  const Mat3 gradient = (Mat3() << 1, 2, 3, -1, 0.5, 2, 0.3, -2, 1).finished();
  const auto flow = [&](const Vec3& x) { return Vec3(Vec3(1, -2, 0.5) + gradient * x); };
  const auto grid = [](int nx, int ny) {
    std::vector<Vec3> points;
    for (int i = 0; i < nx; ++i)
      for (int j = 0; j < ny; ++j) points.push_back(0.3 * Vec3(i, j, 0));
    return points;
  };
  struct Case {
    const char* name;
    std::vector<Vec3> particles;
    int spread;  // number of directions, x first
  };
  const Case cases[] = {{"one", {Vec3::Zero()}, 0},
                        {"coincident", {Vec3::Zero(), Vec3::Zero()}, 0},
                        {"two", grid(2, 1), 1},
                        {"line", grid(5, 1), 1},
                        {"plane", grid(4, 4), 2}};
  for (const Case& c : cases) {
    const MetaballField field = moving(c.particles, velocities_of(c.particles, flow), 1);
    const Vec3 at = c.particles.front() + Vec3(0.1, 0.05, 0.2);
    const LocalFlow found = local_flow(field, at);
    ASSERT_TRUE(found.defined) << c.name;
    Vec3 known = c.particles.front();  // the point's foot on what the particles span
    for (int axis = 0; axis < c.spread; ++axis) known[axis] = at[axis];
    Mat3 expected = Mat3::Zero();
    for (int j = 0; j < c.spread; ++j) expected.col(j) = gradient.col(j);
    for (int j = c.spread; j < 3; ++j) {
      for (int i = 0; i < c.spread; ++i) expected(i, j) = -gradient(j, i);  // as if they turned
    }
    EXPECT_LT((found.velocity - flow(known) - expected * (at - known)).norm(), 1e-8) << c.name;
    EXPECT_LT((found.gradient - expected).norm(), 1e-8) << c.name;
  }
}

TEST(MovingLeastSquares, ParticlesThatCircleEachOtherTurn) {
  const auto spin = [](const Vec3& x) { return Vec3(Vec3(0, 0.3, 1).cross(x)); };
  const std::vector<Vec3> pair = {{-0.3, 0, 0}, {0.3, 0, 0}};
  const std::vector<Vec3> three = {{0.3, 0, 0}, {-0.15, 0.26, 0}, {-0.15, -0.26, 0}};
  for (const auto& particles : {pair, three}) {
    const MetaballField field = moving(particles, velocities_of(particles, spin), 1);
    for (const Vec3& x : {Vec3(0.1, 0.3, 0.2), Vec3(-0.2, 0, 0.3)}) {
      EXPECT_LT((local_flow(field, x).velocity - spin(x)).norm(), 1e-6);
    }
  }
}

TEST(MovingLeastSquares, NearlyDegenerateParticlesDoNotMakeTheVelocityRunAway) {
  Random random(74);
  for (const double thickness : {1e-1, 1e-2, 1e-3, 1e-5, 1e-9, 0.0}) {
    std::vector<Vec3> particles, velocities;
    for (int i = 0; i < 12; ++i) {
      particles.push_back(0.5 * random.vector().cwiseProduct(Vec3(1, 1, thickness)));
      velocities.push_back(random.vector());
    }
    for (int i = 0; i < 20; ++i) {
      const LocalFlow found = local_flow(moving(particles, velocities, 1), 0.4 * random.vector());
      EXPECT_TRUE(is_finite(found));
      EXPECT_LT(found.velocity.norm(), 30);
    }
  }
}

TEST(MovingLeastSquares, IsUndefinedButFiniteWithoutParticles) {
  const MetaballField none({}, {}, {1, 0.5, 1});
  const MetaballField far = moving({Vec3(5, 0, 0)}, {Vec3(1, 1, 1)}, 1);
  const MetaballField at_rim = moving({Vec3(std::nextafter(1.0, 0.0), 0, 0)}, {Vec3(1, 1, 1)}, 1);
  EXPECT_FALSE(local_flow(none, Vec3::Zero()).defined);
  EXPECT_FALSE(local_flow(far, Vec3::Zero()).defined);
  EXPECT_EQ(local_flow(far, Vec3::Zero()).velocity, Vec3(Vec3::Zero()));
  const LocalFlow rim = local_flow(at_rim, Vec3::Zero());
  EXPECT_TRUE(is_finite(rim));
  const Vec3 expected = rim.defined ? Vec3(1, 1, 1) : Vec3(0, 0, 0);
  EXPECT_LT((rim.velocity - expected).norm(), 1e-12);
  const MetaballField still({Vec3::Zero()}, {}, {1, 0.5, 1});
  EXPECT_TRUE(local_flow(still, Vec3::Zero()).defined);
  EXPECT_EQ(local_flow(still, Vec3::Zero()).misfit, 0);
}

TEST(MovingLeastSquares, ScalesWithTheScene) {
  const std::vector<Vec3> particles = ball_particles();
  const auto flow = [](const Vec3& x) { return Vec3(std::sin(3 * x.y()), x.x() * x.z(), std::cos(2 * x.x())); };
  const std::vector<Vec3> velocities = velocities_of(particles, flow);
  const Vec3 x(0.2, -0.3, 0.4);
  const LocalFlow here = local_flow(moving(particles, velocities, 2.5 * spacing), x);
  for (const double length : {1e3, 1e-3}) {
    for (const double speed : {1.0, 1e3, 1e-3}) {
      std::vector<Vec3> positions = particles, scaled = velocities;
      for (Vec3& p : positions) p *= length;
      for (Vec3& v : scaled) v *= speed;
      const LocalFlow there = local_flow(moving(positions, scaled, 2.5 * spacing * length), length * x);
      EXPECT_EQ(there.neighbors, here.neighbors);
      EXPECT_LT((there.velocity / speed - here.velocity).norm(), 1e-12);
      EXPECT_LT((there.gradient * length / speed - here.gradient).norm(), 1e-11);
      EXPECT_NEAR(there.misfit, here.misfit, 1e-12);
    }
  }
}

}  // namespace
}  // namespace flowskin::tracking::moving_least_squares_test
