// The velocity methods on flows whose velocity is known, under changes of frame, and where there is nothing to see.
#include <gtest/gtest.h>
#include <omp.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include "tests/tracking/field_test_bodies.h"
#include "tracking/extraction/extract_surface.h"
#include "tracking/field/metaballs/metaball_field.h"
#include "tracking/mesh/adjacency.h"
#include "tracking/velocity/velocity_method.h"

namespace flowskin::tracking::velocity_test {
namespace {

using test::lattice;
using test::Random;
using test::velocities_of;

constexpr double spacing = 1.0 / 7;
const std::vector<std::string> all_methods = {
    "normal", "total", "curvature", "curvature-belyaev", "rigid", "rigid-global", "affine", "simulation", "hybrid"};
/// Those that look at one point of the field at a time; the surface is met exactly.
const std::vector<std::string> pointwise_methods = {"normal", "total", "curvature", "curvature-belyaev", "rigid"};

struct Body {
  std::vector<Vec3> particles;
  FieldSettings settings;
  std::vector<Vec3> surface;  ///< Points on f = 0.
  MeshAdjacency topology;     ///< Of the mesh on them.
};

/// Points on f = 0: from far outside along rays to the centre, then by Newton's method [FMM13, Eq. 12].
std::vector<Vec3> surface_points(const MetaballField& field, const Vec3& centre, double reach, int count,
                                 std::uint64_t seed) {
  Random random(seed);
  std::vector<Vec3> points;
  const double radius = field.settings().radius;
  for (int tries = 0; tries < 20 * count && static_cast<int>(points.size()) < count; ++tries) {
    const Vec3 from = reach * random.vector().normalized();
    double share = 1;
    while (share > 0 && field.value(centre + share * from) < 0) share -= 0.05 * radius / reach;
    Vec3 x = centre + share * from;
    Vec3 gradient = Vec3::Zero();
    for (int i = 0; i < 30; ++i) {
      const double value = field.value(x, gradient);
      if (gradient.norm() * radius < 1e-3 * field.settings().weight) break;
      x -= value / gradient.squaredNorm() * gradient;
    }
    if (std::abs(field.value(x, gradient)) < 1e-9 && gradient.norm() * radius > 1e-2) points.push_back(x);
  }
  return points;
}

Body make_body(bool ball, double radius_in_spacings) {
  Body body;
  const Vec3 half = Vec3::Constant(0.5 * spacing);
  body.particles = lattice(spacing, 5, 0.2, 31, [&](const Vec3& x) {
    return ball ? (x + half).norm() < 4.35 * spacing : x.cwiseAbs().maxCoeff() < 3.1 * spacing;
  });
  if (ball) {
    for (Vec3& particle : body.particles) particle += half;
  }
  body.settings = default_field_settings(spacing, radius_in_spacings);
  const SurfaceGeometry surface = extract_surface(MetaballField(body.particles, {}, body.settings), 0.7 * spacing);
  body.surface = surface.positions;
  body.topology = build_adjacency(static_cast<int>(surface.positions.size()), surface.triangles);
  return body;
}

std::vector<Body> test_bodies() {
  return {make_body(true, 2), make_body(true, 3), make_body(false, 2), make_body(false, 3)};
}

using Flow = std::function<Vec3(const Vec3&)>;

Flow translation() {
  return [](const Vec3&) { return Vec3(0.7, -0.3, 0.5); };
}
Flow rotation() {
  return [](const Vec3& x) { return Vec3(Vec3(0.3, 1, 0.2).cross(x)); };
}

std::vector<Vec3> evaluate(const std::string& method, const std::vector<Vec3>& particles,
                           const std::vector<Vec3>& velocities, const FieldSettings& settings,
                           const std::vector<Vec3>& points, const MeshAdjacency& topology = {}) {
  std::vector<Vec3> result;
  make_velocity_method(method)->evaluate(MetaballField(particles, velocities, settings), topology, points, result);
  return result;
}

/// Relative RMS error of a method's velocity on the body's surface; `noise` in RMS speeds of the particles.
double relative_error(const std::string& method, const Body& body, const Flow& flow, double noise = 0) {
  std::vector<Vec3> velocities = velocities_of(body.particles, flow);
  double square = 0;
  for (const Vec3& v : velocities) square += v.squaredNorm();
  const double speed = std::sqrt(square / static_cast<double>(velocities.size()));
  Random random(33);
  for (Vec3& v : velocities) v += noise * speed * random.vector();  // of RMS length noise * speed
  const std::vector<Vec3> found =
      evaluate(method, body.particles, velocities, body.settings, body.surface, body.topology);
  double error = 0, size = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Vec3 truth = flow(body.surface[i]);
    error += (found[i] - truth).squaredNorm();
    size += truth.squaredNorm();
  }
  return std::sqrt(error / size);
}

TEST(Velocity, RegistryNamesItsMethods) {
  ASSERT_GE(velocity_methods().size(), all_methods.size());
  for (std::size_t i = 0; i < all_methods.size(); ++i) {
    EXPECT_EQ(velocity_methods()[i].name, all_methods[i]);
    EXPECT_FALSE(velocity_methods()[i].summary.empty());
    EXPECT_NE(make_velocity_method(all_methods[i]), nullptr);
  }
  try {
    make_velocity_method("curvture");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("curvature-belyaev"), std::string::npos);
  }
}

TEST(Velocity, TranslationIsExact) {
  for (const Body& body : test_bodies()) {
    for (const std::string& method : all_methods) {
      if (method == "normal") continue;
      EXPECT_LT(relative_error(method, body, translation()), 1e-9) << method;
    }
    EXPECT_GT(relative_error("normal", body, translation()), 0.5);
  }
}

TEST(Velocity, RotationIsExactForRigidMotions) {
  for (const Body& body : test_bodies()) {
    for (const std::string method : {"rigid", "rigid-global", "affine", "simulation", "hybrid"}) {
      EXPECT_LT(relative_error(method, body, rotation()), 1e-6) << method;
    }
  }
}

/// The mesh of a few particles.
Body small_body(const std::vector<Vec3>& particles) {
  Body body{particles, {1, 0.5, 1}, {}, {}};
  const SurfaceGeometry surface = extract_surface(MetaballField(particles, {}, body.settings), 0.15);
  body.surface = surface.positions;
  body.topology = build_adjacency(static_cast<int>(surface.positions.size()), surface.triangles);
  return body;
}

// The field leaves spin and strain open here; the plainest motion is taken.
TEST(Velocity, CoupledMotionsOfAFewParticlesArePlain) {
  const Body ball = small_body({Vec3(0.1, 0.2, 0.3)});
  for (const std::string& method : all_methods) {
    if (method == "normal") continue;
    EXPECT_LT(relative_error(method, ball, translation()), 1e-6) << method;
  }
  const Body pair = small_body({{-0.3, 0, 0}, {0.3, 0, 0}});
  const Flow across = [](const Vec3& x) { return Vec3(Vec3(0, 1, 0.5).cross(x)); };
  for (const std::string method : {"rigid-global", "affine"}) {
    EXPECT_LT(relative_error(method, pair, across), 1e-6) << method;
  }
}

TEST(Velocity, LinearFlowsAreExactForAffineMotions) {
  Mat3 gradient;
  gradient << 0.3, 1, -0.2, 0.1, -0.4, 0.7, 0.5, 0.2, 0.25;
  const Flow linear = [&](const Vec3& x) { return Vec3(gradient * x + Vec3(0.1, 0.2, -0.3)); };
  for (const Body& body : test_bodies()) {
    EXPECT_LT(relative_error("affine", body, linear), 1e-9);
    EXPECT_LT(relative_error("hybrid", body, linear), 1e-9);
    EXPECT_GT(relative_error("rigid-global", body, linear), 0.05);
  }
}

TEST(Velocity, TheSurfaceIsMetExactly) {
  const Body body = make_body(true, 2);
  Random random(34);
  std::vector<Vec3> velocities;
  for (std::size_t i = 0; i < body.particles.size(); ++i) velocities.push_back(random.vector());
  const MetaballField field(body.particles, velocities, body.settings);
  for (const std::string& method : pointwise_methods) {
    const std::vector<Vec3> found =
        evaluate(method, body.particles, velocities, body.settings, body.surface, body.topology);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const MotionJet jet = field.motion_jet(body.surface[i]);
      const double terms = std::abs(jet.value_rate) + jet.gradient.norm() * found[i].norm();
      EXPECT_NEAR(jet.value_rate + jet.gradient.dot(found[i]), 0, 1e-10 * terms) << method;
    }
  }
}

struct NamedFlow {
  std::string name;
  Flow flow;
  double noise;
  double bound;
};

std::vector<NamedFlow> test_flows() {
  constexpr double pi = std::numbers::pi;
  return {{"translation", translation(), 0, 0.8},
          {"rotation", rotation(), 0, 0.45},
          {"shear", [](const Vec3& x) { return Vec3(x.y(), 0, 0); }, 0, 0.8},
          {"stretch", [](const Vec3& x) { return Vec3(x.x(), -x.y() / 2, -x.z() / 2); }, 0, 0.8},
          {"vortex",
           [](const Vec3& x) {
             return Vec3(-std::sin(pi * x.x()) * std::cos(pi * x.y()), std::cos(pi * x.x()) * std::sin(pi * x.y()), 0);
           },
           0, 0.8},
          {"rotation with noise", rotation(), 0.05, 0.8}};
}

TEST(Velocity, CurvatureNeverBlowsUp) {
  for (const Body& body : test_bodies()) {
    ASSERT_GT(body.surface.size(), 400U);
    for (const NamedFlow& flow : test_flows()) {
      EXPECT_LT(relative_error("curvature", body, flow.flow, flow.noise), flow.bound)
          << flow.name << ", radius " << body.settings.radius / spacing << " spacings";
    }
  }
}

TEST(Velocity, CurvatureSeesRotationAndTotalDoesNot) {
  for (const Body& body : test_bodies()) {
    EXPECT_LT(relative_error("curvature", body, rotation()), 0.3);
    EXPECT_GT(relative_error("total", body, rotation()), 0.6);
  }
}

TEST(Velocity, BelyaevEqualsKanatani) {
  for (const Body& body : test_bodies()) {
    for (const NamedFlow& flow : test_flows()) {
      const std::vector<Vec3> velocities = velocities_of(body.particles, flow.flow);
      const auto a = evaluate("curvature", body.particles, velocities, body.settings, body.surface, body.topology);
      const auto b =
          evaluate("curvature-belyaev", body.particles, velocities, body.settings, body.surface, body.topology);
      double largest = 0;
      for (const Vec3& v : a) largest = std::max(largest, v.norm());
      for (std::size_t i = 0; i < a.size(); ++i) EXPECT_LE((a[i] - b[i]).norm(), 1e-10 * largest) << flow.name;
    }
  }
}

// Where the surface curves strongly, `total` is Eq. 5: what it moves along keeps its normal.
TEST(Velocity, TotalKeepsTheNormal) {
  const std::vector<Vec3> particles = {{-0.3, 0, 0}, {0.3, 0, 0}, {0, 0.4, 0.1}};
  const FieldSettings settings{1, 0.6, 1};
  const std::vector<Vec3> velocities = velocities_of(particles, rotation());
  const MetaballField field(particles, velocities, settings);
  const std::vector<Vec3> points = surface_points(field, Vec3::Zero(), 2, 200, 35);
  const std::vector<Vec3> found = evaluate("total", particles, velocities, settings, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const MotionJet jet = field.motion_jet(points[i]);
    const Vec3 n = jet.gradient.normalized();
    const Vec3 change = jet.gradient_rate + jet.hessian * found[i];
    const Vec3 turning = (change - n * n.dot(change)) / jet.gradient.norm();
    EXPECT_LT(turning.norm(), 0.25 * rotation()(Vec3::UnitX()).norm());
  }
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

// A body of two particles has an axis of symmetry: spin about it is invisible, motion along its meridians is not,
// except near the poles and the equator, where the curvatures do not change along the meridian.
TEST(Velocity, RotationOfTwoParticlesAlongTheirMeridians) {
  const std::vector<Vec3> particles = {{-0.3, 0, 0}, {0.3, 0, 0}};
  const FieldSettings settings{1, 0.6, 1};
  const std::vector<Vec3> velocities = velocities_of(particles, rotation());
  const MetaballField field(particles, velocities, settings);
  const std::vector<Vec3> points = surface_points(field, Vec3::Zero(), 2, 300, 36);
  const std::vector<Vec3> found = evaluate("curvature", particles, velocities, settings, points);
  std::vector<double> errors;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 around = Vec3::UnitX().cross(points[i]).normalized();
    const Vec3 difference = found[i] - rotation()(points[i]);
    errors.push_back((difference - around * around.dot(difference)).norm());
  }
  EXPECT_LT(median(errors), 1e-3);
  EXPECT_LT(*std::max_element(errors.begin(), errors.end()), 0.8);  // the body's surface moves at up to 0.9
}

TEST(Velocity, RotationOfThreeParticles) {
  const std::vector<Vec3> particles = {{0.3, 0, 0}, {-0.15, 0.26, 0}, {-0.15, -0.26, 0}};
  Body body{particles, {1, 0.6, 1}, {}, {}};
  body.surface = surface_points({particles, {}, body.settings}, Vec3::Zero(), 2, 500, 37);
  const Flow spin = [](const Vec3& x) { return Vec3(Vec3::UnitZ().cross(x)); };
  EXPECT_LT(relative_error("curvature", body, spin), 0.3);
  EXPECT_GT(relative_error("total", body, spin), 0.8);
  const std::vector<Vec3> found =
      evaluate("curvature", particles, velocities_of(particles, spin), body.settings, body.surface, body.topology);
  std::vector<double> errors;
  for (std::size_t i = 0; i < found.size(); ++i) {
    errors.push_back((found[i] - spin(body.surface[i])).norm() / spin(body.surface[i]).norm());
  }
  EXPECT_LT(median(errors), 1e-3);
}

TEST(Velocity, IsEquivariant) {
  const Body body = make_body(true, 2);
  const Mat3 turn = Eigen::AngleAxisd(1.1, Vec3(1, 2, -0.5).normalized()).toRotationMatrix();
  const Vec3 shift(0.3, -2, 0.7);
  for (const NamedFlow& flow : test_flows()) {
    const std::vector<Vec3> velocities = velocities_of(body.particles, flow.flow);
    for (const auto& [scale, time] : {std::pair(1.0, 1.0), std::pair(1000.0, 1.0), std::pair(0.001, -1.0)}) {
      const auto moved = [&, size = scale](const Vec3& x) { return Vec3(size * (turn * x + shift)); };
      const auto carried = [&, factor = scale * time](const Vec3& v) { return Vec3(factor * (turn * v)); };
      FieldSettings settings = body.settings;
      settings.radius *= scale;
      settings.weight *= 3;
      settings.threshold *= 3;
      std::vector<Vec3> points = velocities_of(body.surface, moved);
      for (const std::string& method : all_methods) {
        const auto a = evaluate(method, body.particles, velocities, body.settings, body.surface, body.topology);
        const auto b = evaluate(method, velocities_of(body.particles, moved), velocities_of(velocities, carried),
                                settings, points, body.topology);
        double largest = 0;
        for (const Vec3& v : b) largest = std::max(largest, v.norm());
        for (std::size_t i = 0; i < a.size(); ++i) {
          EXPECT_LE((carried(a[i]) - b[i]).norm(), 1e-9 * largest) << method << ", " << flow.name;
        }
      }
    }
  }
}

TEST(Velocity, DoesNotDependOnTheNumberOfThreads) {
  const Body body = make_body(true, 2);
  const std::vector<Vec3> velocities = velocities_of(body.particles, test_flows()[4].flow);
  const int threads = omp_get_max_threads();
  for (const std::string& method : all_methods) {
    omp_set_num_threads(1);
    const auto one = evaluate(method, body.particles, velocities, body.settings, body.surface, body.topology);
    omp_set_num_threads(3);
    const auto three = evaluate(method, body.particles, velocities, body.settings, body.surface, body.topology);
    EXPECT_EQ(one, three) << method;
  }
  omp_set_num_threads(threads);
}

TEST(Velocity, WhereTheFieldIsSilentTheResultIsDefined) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const FieldSettings settings{1, 0.2, 1};
  const Vec3 v(1, 2, 3);
  const std::vector<std::vector<Vec3>> bodies = {
      {}, {Vec3::Zero()}, {Vec3::Zero(), Vec3::Zero()}, {-0.5 * Vec3::UnitX(), 0.5 * Vec3::UnitX()}};
  const std::vector<Vec3> points = {Vec3::Zero(),    Vec3(5, 0, 0),     Vec3(1, 0, 0),    Vec3(0, 0.999999999, 0),
                                    Vec3(nan, 0, 0), Vec3(1e300, 0, 0), Vec3(1e-12, 0, 0)};
  for (const auto& particles : bodies) {
    for (const bool moving : {true, false}) {
      std::vector<Vec3> velocities(moving ? particles.size() : 0, v);
      if (velocities.size() > 1) velocities.back() = -v;
      for (const auto& [method, summary, create, needs_particle_velocities] : velocity_methods()) {
        if (needs_particle_velocities && velocities.size() != particles.size()) {
          EXPECT_THROW(evaluate(method, particles, velocities, settings, points), std::invalid_argument);
          continue;
        }
        const auto found = evaluate(method, particles, velocities, settings, points);
        ASSERT_EQ(found.size(), points.size());
        for (const Vec3& velocity : found) EXPECT_TRUE(velocity.allFinite()) << method;
        EXPECT_EQ(found[1], Vec3::Zero());
        if (!moving) {
          for (const Vec3& velocity : found) EXPECT_EQ(velocity, Vec3::Zero()) << method;
        }
      }
    }
  }
}

// One ball: its spin is invisible, its path is not.
TEST(Velocity, OneParticleIsFollowed) {
  const FieldSettings settings{1, 0.2, 1};
  const Vec3 v(1, 2, 3);
  const MetaballField field({Vec3(0.1, 0.2, 0.3)}, {v}, settings);
  const std::vector<Vec3> points = surface_points(field, Vec3(0.1, 0.2, 0.3), 2, 50, 38);
  for (const std::string method : {"total", "curvature", "curvature-belyaev"}) {
    for (const Vec3& found : evaluate(method, field.positions(), field.velocities(), settings, points)) {
      EXPECT_LE((found - v).norm(), 1e-9) << method;
    }
  }
}

}  // namespace
}  // namespace flowskin::tracking::velocity_test
