// Prescribed motions against independent integration of their velocity fields.
#include "scenes/sources/prescribed_source.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <numbers>

#include "scene_file_helpers.h"
#include "scenes/sources/make_source.h"

namespace flowskin::scenes {
namespace {

using std::numbers::pi;
using Field = std::function<Vec3(const Vec3& position, double time)>;

Scene points_scene(const MotionSpec& motion) {
  Scene scene;
  scene.particles.source = ParticlesSpec::Source::prescribed;
  scene.particles.spacing = 0.1;
  scene.particles.positions = {{0.3, 0.2, 0.1}, {-0.4, 0.7, 0.2}, {0.05, -0.6, -0.3}, {0, 0, 0}};
  scene.particles.motion = motion;
  return scene;
}

/// The path of a field by many small steps of the midpoint rule with Richardson's extrapolation: another method than
/// the source's own.
Vec3 integrate(const Field& field, const Vec3& start, double time) {
  const auto midpoint = [&](int steps) {
    Vec3 x = start;
    const double dt = time / steps;
    for (int k = 0; k < steps; ++k) {
      const double t = k * dt;
      x += dt * field(x + 0.5 * dt * field(x, t), t + 0.5 * dt);
    }
    return x;
  };
  return (4 * midpoint(8000) - midpoint(4000)) / 3;
}

struct Case {
  MotionSpec motion;
  Field field;  ///< The formula of docs/scenes.md, written once more.
};

std::vector<Case> cases() {
  const Vec3 center(0.1, -0.2, 0.3), spin(0.5, -1, 2), u(0.4, 0.3, -0.2);
  const double rate = 0.8;
  MotionSpec rotation, translation, shear, stretch, vortex;
  rotation.type = "rotation";
  rotation.center = center;
  rotation.angular_velocity = spin;
  translation.type = "translation";
  shear.type = "shear";
  stretch.type = "stretch";
  stretch.center = center;
  vortex.type = "vortex";
  shear.rate = stretch.rate = vortex.rate = rate;
  for (MotionSpec* motion : {&rotation, &translation, &shear, &stretch, &vortex}) motion->velocity = u;
  return {
      {rotation, [=](const Vec3& x, double t) -> Vec3 { return spin.cross(x - u * t - center) + u; }},
      {translation, [=](const Vec3&, double) -> Vec3 { return u; }},
      {shear, [=](const Vec3& x, double t) -> Vec3 { return Vec3(rate * (x.y() - u.y() * t), 0, 0) + u; }},
      {stretch,
       [=](const Vec3& x, double t) -> Vec3 {
         const Vec3 y = x - u * t - center;
         return rate * Vec3(y.x(), -y.y() / 2, -y.z() / 2) + u;
       }},
      {vortex,
       [=](const Vec3& x, double t) -> Vec3 {
         const Vec3 y = x - u * t;
         return rate *
                    Vec3(-std::sin(pi * y.x()) * std::cos(pi * y.y()), std::cos(pi * y.x()) * std::sin(pi * y.y()), 0) +
                u;
       }},
  };
}

TEST(PrescribedSource, PathsFollowTheVelocityField) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.motion.type);
    const auto source = make_source(points_scene(c.motion));
    const std::vector<Vec3> start = source->state().positions;
    for (const double time : {0.0, 0.37, 1.5}) {
      source->advance_to(time);
      const ParticleState& state = source->state();
      EXPECT_EQ(state.time, time);
      for (std::size_t i = 0; i < start.size(); ++i) {
        EXPECT_LT((state.positions[i] - integrate(c.field, start[i], time)).norm(), 1e-7) << i;
        EXPECT_LT((state.velocities[i] - c.field(state.positions[i], time)).norm(), 1e-12) << i;
        EXPECT_EQ(state.rest_positions[i], start[i]);
      }
    }
  }
}

TEST(PrescribedSource, PositionsDoNotDependOnTheTimesAskedFor) {
  for (const Case& c : cases()) {
    const auto at_once = make_source(points_scene(c.motion)), in_steps = make_source(points_scene(c.motion));
    at_once->advance_to(1.3);
    for (const double time : {0.001, 0.02, 0.02, 0.7, 1.29, 1.3}) in_steps->advance_to(time);
    EXPECT_EQ(at_once->state().positions, in_steps->state().positions) << c.motion.type;
    EXPECT_EQ(at_once->state().velocities, in_steps->state().velocities) << c.motion.type;
  }
}

TEST(PrescribedSource, ARotationComesBackAfterAWholeTurn) {
  const Scene scene = read_scene(source_folder() / "scenes" / "rotating_ring.json", test_vocabulary());
  const auto source = make_source(scene);
  ASSERT_EQ(source->state().positions.size(), 3u);
  source->advance_to(0.5);
  EXPECT_LT((source->state().positions[0] - Vec3(0, 0, -0.3)).norm(), 1e-12);
  source->advance_to(2);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LT((source->state().positions[i] - source->state().rest_positions[i]).norm(), 1e-12);
  }
}

TEST(PrescribedSource, IsIncompressible) {
  // Every field but the translation of it has no divergence, by central differences.
  for (const Case& c : cases()) {
    const Motion motion(c.motion);
    for (const Vec3& x : points_scene(c.motion).particles.positions) {
      double divergence = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const Vec3 step = 1e-5 * Vec3::Unit(axis);
        divergence += (motion.velocity(x + step, 0.2) - motion.velocity(x - step, 0.2))[axis] / 2e-5;
      }
      EXPECT_NEAR(divergence, 0, 1e-8) << c.motion.type;
    }
  }
}

Scene ball_scene(double jitter, std::uint64_t seed) {
  return parse("{\"seed\": " + std::to_string(seed) +
               R"(, "particles": {"source": "prescribed", "spacing": 0.1, "jitter": )" + std::to_string(jitter) +
               R"(, "motion": {"type": "translation"}},
                 "bodies": [{"shape": "ball", "center": [1, 2, 3], "radius": 0.5}]})");
}

TEST(PrescribedSource, BodiesAreFilledAndJitteredByTheSeed) {
  const auto plain = make_source(ball_scene(0, 1)), first = make_source(ball_scene(0.2, 1)),
             again = make_source(ball_scene(0.2, 1)), other = make_source(ball_scene(0.2, 2));
  const auto& lattice = plain->state().positions;
  EXPECT_NEAR(static_cast<double>(lattice.size()), 4.0 / 3 * pi * 125, 0.08 * 524);
  EXPECT_EQ(first->state().positions, again->state().positions);
  EXPECT_NE(first->state().positions, other->state().positions);
  double largest = 0;
  for (std::size_t i = 0; i < lattice.size(); ++i) {
    largest = std::max(largest, (first->state().positions[i] - lattice[i]).cwiseAbs().maxCoeff());
  }
  EXPECT_LE(largest, 0.02 + 1e-12);
  EXPECT_GT(largest, 0.019);
}

TEST(PrescribedSource, IdsAscendAndTimeOnlyGoesForward) {
  const auto source = make_source(ball_scene(0.1, 1));
  const ParticleState& state = source->state();
  EXPECT_EQ(state.time, 0);
  EXPECT_TRUE(std::is_sorted(state.ids.begin(), state.ids.end()));
  EXPECT_EQ(state.velocities.size(), state.ids.size());
  EXPECT_EQ(state.densities.size(), state.ids.size());
  source->advance_to(1);
  source->advance_to(1);
  EXPECT_THROW(source->advance_to(0.5), std::invalid_argument);
  EXPECT_THROW(source->advance_to(std::nan("")), std::invalid_argument);
  EXPECT_FALSE(source->ends_before(1e6));
}

TEST(PrescribedSource, UnknownMotionIsAnError) {
  MotionSpec motion;
  motion.type = "rotatoin";
  try {
    make_source(points_scene(motion));
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean \"rotation\"?"), std::string::npos);
  }
}

}  // namespace
}  // namespace flowskin::scenes
