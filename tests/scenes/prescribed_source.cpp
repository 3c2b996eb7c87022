// Prescribed motions against independent integration of their velocity fields.
#include "scenes/sources/prescribed_source.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <numbers>

#include "scene_file_helpers.h"
#include "scenes/sources/make_source.h"

namespace flowskin::scenes::prescribed_source_test {
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
  const Vec3 axis(2, -1, 2);
  const double length = 0.3, period = 2;
  MotionSpec rotation, translation, shear, stretch, necking, hole, vortex, deformation;
  rotation.type = "rotation";
  rotation.center = center;
  rotation.angular_velocity = spin;
  translation.type = "translation";
  shear.type = "shear";
  stretch.type = "stretch";
  stretch.center = center;
  vortex.type = "vortex";
  necking.type = "necking";
  hole.type = "hole";
  deformation.type = "deformation";
  shear.rate = stretch.rate = necking.rate = vortex.rate = deformation.rate = rate;
  stretch.center = necking.center = hole.center = center;
  stretch.axis = necking.axis = hole.axis = axis;
  necking.length = hole.length = length;
  hole.period = deformation.period = period;
  for (MotionSpec* motion : {&rotation, &translation, &shear, &stretch, &necking, &hole, &vortex, &deformation})
    motion->velocity = u;
  const Vec3 a = axis / 3;
  return {
      {rotation, [=](const Vec3& x, double t) -> Vec3 { return spin.cross(x - u * t - center) + u; }},
      {translation, [=](const Vec3&, double) -> Vec3 { return u; }},
      {shear, [=](const Vec3& x, double t) -> Vec3 { return Vec3(rate * (x.y() - u.y() * t), 0, 0) + u; }},
      {stretch,
       [=](const Vec3& x, double t) -> Vec3 {
         const Vec3 y = x - u * t - center;
         return rate * (1.5 * a.dot(y) * a - 0.5 * y) + u;
       }},
      {necking,
       [=](const Vec3& x, double t) -> Vec3 {
         const Vec3 y = x - u * t - center;
         const double z = a.dot(y), tanh = std::tanh(z / length);
         return rate * (length * tanh * a - 0.5 * (1 - tanh * tanh) * (y - z * a)) + u;
       }},
      // Only where there is material.
      {hole,
       [=](const Vec3& x, double t) -> Vec3 {
         const Vec3 y = x - u * t - center, r = y - a.dot(y) * a;
         const double angle = pi * t / period;
         return length * length * pi / period * std::sin(angle) * std::cos(angle) * r / r.squaredNorm() + u;
       }},
      {vortex,
       [=](const Vec3& x, double t) -> Vec3 {
         const Vec3 y = x - u * t;
         return rate *
                    Vec3(-std::sin(pi * y.x()) * std::cos(pi * y.y()), std::cos(pi * y.x()) * std::sin(pi * y.y()), 0) +
                u;
       }},
      {deformation,
       [=](const Vec3& x, double t) -> Vec3 {
         const Vec3 y = x - u * t;
         const auto sin2 = [](double p) { return (1 - std::cos(2 * pi * p)) / 2; };
         const auto sine = [](double p) { return std::sin(2 * pi * p); };
         return rate * std::cos(pi * t / period) *
                    Vec3(2 * sin2(y.x()) * sine(y.y()) * sine(y.z()), -sine(y.x()) * sin2(y.y()) * sine(y.z()),
                         -sine(y.x()) * sine(y.y()) * sin2(y.z())) +
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
  const Scene scene = read_scene(source_folder() / "scenes" / "rotating_ring.json");
  const auto source = make_source(scene);
  ASSERT_EQ(source->state().positions.size(), 3u);
  source->advance_to(0.5);
  EXPECT_LT((source->state().positions[0] - Vec3(0, 0, -0.3)).norm(), 1e-12);
  source->advance_to(2);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LT((source->state().positions[i] - source->state().rest_positions[i]).norm(), 1e-12);
  }
}

TEST(PrescribedSource, AllMotionsAreTested) {
  std::vector<std::string> tested;
  for (const Case& c : cases()) tested.push_back(c.motion.type);
  EXPECT_EQ(tested, motion_names());
}

TEST(PrescribedSource, ReversingMotionsComeBackAfterThePeriod) {
  for (Case& c : cases()) {
    if (c.motion.type != "hole" && c.motion.type != "deformation") continue;
    SCOPED_TRACE(c.motion.type);
    c.motion.velocity.setZero();
    const Scene scene = points_scene(c.motion);
    const auto source = make_source(scene);
    source->advance_to(c.motion.period / 2);
    // All but the last point, which stands still at a corner of LeVeque's cube.
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_GT((source->state().positions[i] - source->state().rest_positions[i]).norm(), 0.02) << i;
    }
    source->advance_to(c.motion.period);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_LT((source->state().positions[i] - source->state().rest_positions[i]).norm(), 1e-7) << i;
    }
  }
}

TEST(PrescribedSource, PathsKeepVolume) {
  // The determinant of the path's derivative by the start, by central differences, is 1.
  const double h = 3e-5;
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.motion.type);
    Scene scene = points_scene(c.motion);
    const std::vector<Vec3> points = scene.particles.positions;
    scene.particles.positions.clear();
    for (const Vec3& x : points) {
      for (int axis = 0; axis < 3; ++axis) {
        scene.particles.positions.push_back(x + h * Vec3::Unit(axis));
        scene.particles.positions.push_back(x - h * Vec3::Unit(axis));
      }
    }
    const auto source = make_source(scene);
    source->advance_to(0.9);
    for (std::size_t i = 0; i < points.size(); ++i) {
      Eigen::Matrix3d derivative;
      for (int axis = 0; axis < 3; ++axis) {
        const std::size_t k = 6 * i + 2 * static_cast<std::size_t>(axis);
        derivative.col(axis) = (source->state().positions[k] - source->state().positions[k + 1]) / (2 * h);
      }
      EXPECT_NEAR(derivative.determinant(), 1, 1e-5) << i;
    }
  }
}

TEST(PrescribedSource, NeckingMovesTheEndsOffAsTheyAre) {
  MotionSpec spec;
  spec.type = "necking";
  spec.axis = {0, 0, 5};
  spec.rate = 2;
  spec.length = 0.1;
  const Motion motion(spec);
  // Ten lengths from the middle: moved by nearly s L t; in the middle: thinner by exp(-s t / 2).
  EXPECT_NEAR((motion.local_path({0.1, 0, 1}, 1.5) - Vec3(0.1, 0, 1.3)).norm(), 0, 1e-8);
  EXPECT_NEAR((motion.local_path({0.1, 0, 0}, 1.5) - Vec3(0.1 * std::exp(-1.5), 0, 0)).norm(), 0, 1e-15);
}

TEST(PrescribedSource, AHoleHasItsRadiusAndAVelocityEverywhere) {
  MotionSpec spec;
  spec.type = "hole";
  spec.axis = {0, 1, 0};
  spec.length = 0.2;
  spec.period = 4;
  const Motion motion(spec);
  // What is on the axis goes to its edge, and nothing is nearer.
  EXPECT_NEAR(motion.local_path(Vec3(0, 0.3, 0), 2).norm(), std::hypot(0.2, 0.3), 1e-15);
  EXPECT_EQ(motion.local_path(Vec3(0, 0.3, 0), 4).y(), 0.3);
  for (const double time : {0.0, 0.1, 1.0, 2.0, 3.9, 4.0}) {
    for (const double r : {0.0, 1e-9, 0.05, 0.3}) EXPECT_LE(motion.velocity({r, 0.1, 0}, time).norm(), 0.2 * pi / 4);
  }
}

TEST(PrescribedSource, IsIncompressible) {
  // No field has a divergence where there is material, by central differences.
  for (const Case& c : cases()) {
    const Motion motion(c.motion);
    const auto source = make_source(points_scene(c.motion));
    source->advance_to(0.2);
    for (const Vec3& x : source->state().positions) {
      double divergence = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const Vec3 step = 2e-6 * Vec3::Unit(axis);
        divergence += (motion.velocity(x + step, 0.2) - motion.velocity(x - step, 0.2))[axis] / 4e-6;
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
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean \"rotation\"?"), std::string::npos);
  }
}

}  // namespace
}  // namespace flowskin::scenes::prescribed_source_test
