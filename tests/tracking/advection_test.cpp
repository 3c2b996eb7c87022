// Particle paths, integrators and projection.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "tests/tracking/mesh_test_shapes.h"
#include "tracking/advection/integrator.h"
#include "tracking/advection/particle_paths.h"
#include "tracking/advection/projection.h"

namespace flowskin::tracking::advection_test {
namespace {

using test::ball_of_particles;
using test::particles_at;

// x(t) = a cubic in time, so that Hermite interpolation is exact.
Particles cubic_motion(double t) {
  Particles particles = particles_at({Vec3::Zero(), Vec3::Zero()});
  particles.time = t;
  const Vec3 a(1, 2, 3), b(-2, 0.5, 1), c(0.3, -1, 4), d(1, 1, -1);
  for (int i = 0; i < 2; ++i) {
    particles.positions[i] = (i + 1) * (a + b * t + c * t * t + d * t * t * t);
    particles.velocities[i] = (i + 1) * (b + 2 * c * t + 3 * d * t * t);
  }
  return particles;
}

TEST(ParticlePaths, AreExactForCubicMotion) {
  const ParticlePaths paths(cubic_motion(0.5), cubic_motion(1.25));
  for (const double t : {0.5, 0.6, 0.9, 1.2, 1.25}) {
    std::vector<Vec3> positions, velocities;
    paths.at(t, positions, velocities);
    const Particles expected = cubic_motion(t);
    for (int i = 0; i < 2; ++i) {
      EXPECT_LT((positions[i] - expected.positions[i]).norm(), 1e-13 * 30);
      EXPECT_LT((velocities[i] - expected.velocities[i]).norm(), 1e-12 * 30);
    }
  }
}

TEST(ParticlePaths, BoundTheWay) {
  const Particles from = cubic_motion(0), to = cubic_motion(1);
  const ParticlePaths paths(from, to);
  double longest = 0;
  for (int i = 0; i < 2; ++i) {
    double length = 0;
    for (int k = 0; k < 1000; ++k) {
      length += (cubic_motion((k + 1) / 1000.0).positions[i] - cubic_motion(k / 1000.0).positions[i]).norm();
    }
    longest = std::max(longest, length);
  }
  EXPECT_GE(paths.longest_path(), longest);
  EXPECT_LE(paths.longest_path(), 2 * longest);
}

TEST(ParticlePaths, MatchByIdAndExtrapolateWhoComesAndGoes) {
  Particles from = particles_at({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  Particles to = particles_at({{1, 0, 0}, {3, 0, 0}, {9, 0, 0}});
  from.ids = {3, 5, 8};
  to.ids = {3, 8, 20};
  to.time = 0.5;
  from.velocities = {{2, 0, 0}, {0, 4, 0}, {2, 0, 0}};
  to.velocities = {{2, 0, 0}, {2, 0, 0}, {0, 0, 8}};
  const ParticlePaths paths(from, to);
  std::vector<Vec3> positions, velocities;
  paths.at(0.25, positions, velocities);
  ASSERT_EQ(positions.size(), 4U);
  EXPECT_LT((positions[0] - Vec3(0.5, 0, 0)).norm(), 1e-14);
  EXPECT_LT((positions[1] - Vec3(1, 1, 0)).norm(), 1e-14);  // goes on
  EXPECT_LT((positions[2] - Vec3(2.5, 0, 0)).norm(), 1e-14);
  EXPECT_LT((positions[3] - Vec3(9, 0, -2)).norm(), 1e-14);  // comes in
  EXPECT_EQ(velocities[3], Vec3(0, 0, 8));
  paths.at(0.5, positions, velocities);
  EXPECT_EQ(positions, to.positions);
  EXPECT_EQ(velocities, to.velocities);
}

TEST(ParticlePaths, RefuseBadParticles) {
  const Particles good = particles_at({{0, 0, 0}, {1, 0, 0}});
  EXPECT_NO_THROW(check_particles(good));
  Particles bad = good;
  bad.ids = {1, 1};
  EXPECT_THROW(check_particles(bad), std::invalid_argument);
  bad = good;
  bad.velocities.pop_back();
  EXPECT_THROW(check_particles(bad), std::invalid_argument);
  bad = good;
  bad.positions[1][2] = std::numeric_limits<double>::infinity();
  EXPECT_THROW(check_particles(bad), std::invalid_argument);
  bad = good;
  bad.time = std::nan("");
  EXPECT_THROW(check_particles(bad), std::invalid_argument);
}

// A velocity field that is known everywhere: rotation about an axis, with a pull along it.
class AnalyticVelocity : public VelocityMethod {
 public:
  void evaluate(const ImplicitField&, const MeshAdjacency&, const std::vector<Vec3>& positions,
                std::vector<Vec3>& velocities) const override {
    velocities.clear();
    for (const Vec3& x : positions) velocities.push_back(Vec3(0.2, 0.3, 1).cross(x));
  }
};

double error_of_rotation(Integrator integrator, int steps) {
  const std::vector<Vec3> start = {{1, 0, 0}, {0, 2, 1}, {-1, 1, 0.5}};
  const FieldAt field_at = [](double) {
    return shared_field(MetaballField({Vec3::Zero()}, {}, FieldSettings{1, 0.5, 1}));
  };
  std::vector<Vec3> positions = start;
  const double step = 1.0 / steps;
  for (int i = 0; i < steps; ++i) {
    const std::shared_ptr<const ImplicitField> field = field_at(i * step);
    advect_step(AnalyticVelocity(), {}, integrator, *field, field_at, i * step, step, {}, positions);
  }
  double error = 0;
  for (int v = 0; v < 3; ++v) {
    error = std::max(error, (positions[v] - test::rotation({0.2, 0.3, 1}) * start[v]).norm());
  }
  return error;
}

TEST(Integrator, ConvergesWithItsOrder) {
  const std::array<std::pair<Integrator, double>, 3> orders = {
      {{Integrator::euler, 1}, {Integrator::rk2, 2}, {Integrator::rk4, 4}}};
  for (const auto& [integrator, order] : orders) {
    const double coarse = error_of_rotation(integrator, 16), fine = error_of_rotation(integrator, 32);
    EXPECT_NEAR(std::log2(coarse / fine), order, 0.1);
  }
}

// The velocity of the particles' mean: changes with the time of the field, so it tests the times of the stages.
class MeanVelocity : public VelocityMethod {
 public:
  void evaluate(const ImplicitField& field, const MeshAdjacency&, const std::vector<Vec3>& positions,
                std::vector<Vec3>& velocities) const override {
    velocities.assign(positions.size(), field.particles()->velocities().front());
  }
};

TEST(Integrator, AsksForTheFieldAtTheRightTimes) {
  const Particles from = cubic_motion(0), to = cubic_motion(1);
  const ParticlePaths paths(from, to);
  const FieldSettings settings{1, 0.5, 1};
  const FieldAt field_at = [&](double t) { return shared_field(paths.field(t, settings)); };
  const std::vector<Vec3> start = {{5, 5, 5}};
  std::vector<Vec3> positions = start;
  // Simpson's rule, which RK4 becomes here, is exact for the quadratic velocity; the midpoint rule is not.
  advect_step(MeanVelocity(), {}, Integrator::rk4, *field_at(0), field_at, 0, 1, {}, positions);
  EXPECT_LT((positions[0] - start[0] - (to.positions[0] - from.positions[0])).norm(), 1e-12);
  positions = start;
  advect_step(MeanVelocity(), {}, Integrator::rk2, *field_at(0), field_at, 0, 1, {}, positions);
  EXPECT_LT((positions[0] - start[0] - cubic_motion(0.5).velocities[0]).norm(), 1e-12);
}

TEST(Integrator, TakesAFirstVelocityThatIsKnown) {
  std::vector<Vec3> positions = {{1, 0, 0}};
  const FieldAt field_at = [](double) {
    return shared_field(MetaballField({Vec3::Zero()}, {}, FieldSettings{1, 0.5, 1}));
  };
  advect_step(AnalyticVelocity(), {}, Integrator::euler, *field_at(0), field_at, 0, 0.5, {{2, 0, 0}}, positions);
  EXPECT_EQ(positions[0], Vec3(2, 0, 0));
}

TEST(Projection, ReachesTheSphereOfOneParticle) {
  const FieldSettings settings{2, 0.3, 1};
  const MetaballField field({{1, 2, 3}}, {}, settings);
  const double radius = 2 * std::sqrt(1 - std::cbrt(0.3));  // (1 - r^2 / 4)^3 = 0.3
  test::Random random(3);
  for (int i = 0; i < 100; ++i) {
    const Vec3 direction = random.vector().normalized();
    Vec3 x = Vec3(1, 2, 3) + (radius + 0.4 * random.symmetric()) * direction;
    SurfaceDistance point;
    ASSERT_TRUE(project_point(field, default_projection(settings.scale()), x, point));
    EXPECT_NEAR((x - Vec3(1, 2, 3)).norm(), radius, 1e-6);
    EXPECT_LT(((x - Vec3(1, 2, 3)).normalized() - direction).norm(), 1e-6);
    EXPECT_LT((point.normal - direction).norm(), 1e-6);
    EXPECT_LE(point.distance, 2e-7);
  }
}

TEST(Projection, StatesWhereItFailsAndLeavesThePointAlone) {
  const FieldSettings settings{2, 0.3, 1};
  const MetaballField field({{0, 0, 0}}, {}, settings);
  // Outside the support; at the centre where the gradient is zero; so near the rim that the gradient is noise.
  std::vector<Vec3> positions = {{5, 0, 0}, {0, 0, 0}, {1.9999999, 0, 0}, {1.1, 0, 0}};
  const std::vector<Vec3> before = positions;
  const Projection projection = project_to_surface(field, default_projection(settings.scale()), positions);
  EXPECT_EQ(projection.failed, (std::vector<int>{0, 1, 2}));
  EXPECT_TRUE(std::isinf(projection.max_distance));
  for (int v = 0; v < 3; ++v) EXPECT_EQ(positions[v], before[v]);
}

TEST(Projection, FromAnywhereNearAJitteredBody) {
  const FieldSettings settings = default_field_settings(1);
  const MetaballField field(ball_of_particles(5.3), {}, settings);
  test::Random random(8);
  std::vector<Vec3> positions;
  for (int i = 0; i < 500; ++i) positions.push_back((5.5 + random.symmetric()) * random.vector().normalized());
  const Projection projection = project_to_surface(field, default_projection(settings.scale()), positions);
  EXPECT_TRUE(projection.failed.empty());
  EXPECT_LE(projection.max_distance, 1e-6 * settings.radius);
  for (const Vec3& x : positions) EXPECT_NEAR(field.value(x), 0, 1e-5);
}

}  // namespace
}  // namespace flowskin::tracking::advection_test
