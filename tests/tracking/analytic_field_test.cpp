// A field that is not made of particles, tracked by what the interface of implicit fields says of it.
#include "tests/tracking/analytic_field.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>

#include "tests/tracking/field_test_bodies.h"
#include "tracking/advection/projection.h"
#include "tracking/extraction/extract_surface.h"
#include "tracking/field/neighborhoods.h"
#include "tracking/ground_truth/surface_comparison.h"
#include "tracking/mesh/mesh_check.h"
#include "tracking/tracker.h"
#include "tracking/velocity/velocity_method.h"

namespace flowskin::tracking::analytic_field_test {
namespace {

using test::AnalyticMotion;
using test::AnalyticScene;
using test::RigidPath;
using test::round_blob;

constexpr double kEdge = 0.15;

/// A ball with bumps of different sizes, so that no rotation and no affine map leaves it as it is.
AnalyticScene bumpy(const RigidPath& path) {
  AnalyticScene scene;
  scene.blobs = {round_blob({0, 0, 0}, 1, 1), round_blob({0.9, 0.2, 0.1}, 0.5, 0.6),
                 round_blob({-0.3, 0.8, -0.4}, 0.6, 0.5), round_blob({0.1, -0.5, 0.9}, 0.45, 0.7)};
  scene.paths = {path};
  return scene;
}

const RigidPath kTranslation{{0.7, -0.3, 0.5}, Vec3::Zero(), Vec3::Zero()};
const RigidPath kRotation{Vec3::Zero(), {0.4, 0.8, -0.5}, {0.2, -0.1, 0.1}};

std::vector<Vec3> noise(std::size_t count, std::uint64_t seed) {
  test::Random random(seed);
  std::vector<Vec3> vectors;
  for (std::size_t i = 0; i < count; ++i) vectors.push_back(random.vector());
  return vectors;
}

/// (g(h) - g(-h)) / 2h
template <class Function>
auto difference(const Function& g) {
  constexpr double h = 1e-5;
  return ((g(h) - g(-h)) / (2 * h)).eval();
}

TEST(AnalyticField, JetsAreTheDerivativesInSpaceAndTime) {
  RigidPath path = kRotation;
  path.velocity = kTranslation.velocity;
  const AnalyticScene scene = bumpy(path);
  constexpr double time = 0.6;
  const auto field = scene.field(time);
  for (const Vec3& x : noise(30, 91)) {
    const MotionJet jet = field->motion_jet(x);
    Vec3 gradient;
    EXPECT_NEAR(field->value(x, gradient), jet.moving_value, 1e-14);
    EXPECT_LE((gradient - jet.gradient).norm(), 1e-13);
    for (int axis = 0; axis < 3; ++axis) {
      const auto at = [&](double h) { return field->motion_jet(x + h * Vec3::Unit(axis)); };
      using Vec1 = Eigen::Matrix<double, 1, 1>;
      EXPECT_NEAR(difference([&](double h) { return Vec1(at(h).moving_value); })[0], jet.gradient[axis], 1e-8);
      EXPECT_LE((difference([&](double h) { return at(h).gradient; }) - jet.hessian.col(axis)).norm(), 1e-8);
      EXPECT_LE((difference([&](double h) { return at(h).hessian; }) - jet.third[axis]).norm(), 1e-7);
    }
    const auto later = [&](double h) { return scene.field(time + h)->motion_jet(x); };
    using Vec1 = Eigen::Matrix<double, 1, 1>;
    EXPECT_NEAR(difference([&](double h) { return Vec1(later(h).moving_value); })[0], jet.value_rate, 1e-8);
    EXPECT_LE((difference([&](double h) { return later(h).gradient; }) - jet.gradient_rate).norm(), 1e-8);
    EXPECT_LE((difference([&](double h) { return later(h).hessian; }) - jet.hessian_rate).norm(), 1e-7);
  }
}

TEST(AnalyticField, NeighborhoodsGiveTheFieldItself) {
  const auto field = bumpy(kRotation).field(0.2);
  std::vector<Vec3> points = noise(100, 92);
  points.emplace_back(std::nan(""), 0, 0);
  std::vector<int> visits(points.size());
  Neighborhoods(*field, points, 0.1).for_each([&](int i, const LocalField& local) {
    ++visits[i];
    EXPECT_EQ(local.particles(), nullptr);
    if (points[i].allFinite()) {
      EXPECT_EQ(local.value(points[i]), field->value(points[i]));
    }
  });
  EXPECT_EQ(visits, std::vector<int>(points.size(), 1));
}

/// Relative RMS error of a method's velocities on the surface of a moving body.
double velocity_error(const std::string& method, const RigidPath& path) {
  const AnalyticScene scene = bumpy(path);
  constexpr double time = 0.3;
  const auto field = scene.field(time);
  const SurfaceGeometry surface = extract_surface(*field, kEdge);
  std::vector<Vec3> velocities;
  make_velocity_method(method)->evaluate(*field,
                                         build_adjacency(static_cast<int>(surface.positions.size()), surface.triangles),
                                         surface.positions, velocities);
  double error = 0, all = 0;
  for (std::size_t v = 0; v < velocities.size(); ++v) {
    const Vec3 exact = path.velocity_at(surface.positions[v], time);
    error += (velocities[v] - exact).squaredNorm();
    all += exact.squaredNorm();
  }
  EXPECT_GT(surface.positions.size(), 500U);
  return std::sqrt(error / all);
}

TEST(AnalyticField, EachMethodSeesTheMotionsItIsMadeFor) {
  for (const std::string method : {"total", "curvature", "curvature-belyaev", "rigid", "rigid-global", "affine"})
    EXPECT_LT(velocity_error(method, kTranslation), 1e-6) << method << ", translation";
  for (const std::string method : {"rigid-global", "affine"})
    EXPECT_LT(velocity_error(method, kRotation), 1e-3) << method << ", rotation";
  // Between the bumps the body is nearly round: what turns there is seen by the neighbours only.
  EXPECT_LT(velocity_error("rigid", kRotation), 0.5);
  EXPECT_LT(velocity_error("curvature", kRotation), velocity_error("total", kRotation));
  EXPECT_LT(velocity_error("rigid", kRotation), velocity_error("curvature", kRotation));
  // They do not see it, and this measure shows that.
  EXPECT_GT(velocity_error("normal", kTranslation), 0.3);
  EXPECT_GT(velocity_error("total", kRotation), 0.1);
}

TEST(AnalyticField, MethodsThatNeedParticlesSayThatThereAreNone) {
  const auto field = bumpy(kRotation).field(0);
  std::vector<Vec3> velocities;
  for (const std::string method : {"simulation", "hybrid"}) {
    EXPECT_THROW(make_velocity_method(method)->evaluate(*field, {}, {{0, 0, 1}}, velocities), std::invalid_argument);
    TrackerSettings settings;
    settings.edge_length = kEdge;
    settings.velocity = method;
    EXPECT_THROW(Tracker(settings, field, 0), std::invalid_argument) << method;
  }
}

TrackerSettings settings_for(const std::string& method) {
  TrackerSettings settings;
  settings.edge_length = kEdge;
  settings.velocity = method;
  return settings;
}

/// RMS distance of the vertices to where their material has gone, after so many steps.
double path_error(const std::string& method, const RigidPath& path, double duration, int steps) {
  const AnalyticScene scene = bumpy(path);
  Tracker tracker(settings_for(method), scene.field(0), 0);
  for (int step = 1; step <= steps; ++step)
    tracker.advance(AnalyticMotion(scene, duration * (step - 1) / steps, duration * step / steps));
  EXPECT_EQ(tracker.report().components, 1);
  EXPECT_FALSE(tracker.report().reextracted) << tracker.report().reason;
  EXPECT_TRUE(mesh_problems(tracker.mesh()).empty());
  EXPECT_LT(largest_distance(*scene.field(duration), tracker.mesh().positions), 1e-6);
  double sum = 0;
  for (std::size_t v = 0; v < tracker.mesh().positions.size(); ++v)
    sum += (tracker.mesh().positions[v] - path.place(tracker.mesh().rest_positions[v], duration)).squaredNorm();
  return std::sqrt(sum / static_cast<double>(tracker.mesh().positions.size()));
}

TEST(AnalyticField, TextureFollowsATranslation) {
  for (const std::string method : {"total", "curvature", "rigid", "rigid-global", "affine"})
    EXPECT_LT(path_error(method, kTranslation, 3, 12), 0.1 * kEdge) << method;
  EXPECT_GT(path_error("normal", kTranslation, 3, 12), 2 * kEdge) << "left behind";
}

TEST(AnalyticField, TextureFollowsARotation) {
  const double turn = 2 * M_PI / kRotation.spin.norm();
  for (const std::string method : {"rigid-global", "affine"})
    EXPECT_LT(path_error(method, kRotation, turn / 2, 24), 0.2 * kEdge) << method;
  EXPECT_GT(path_error("normal", kRotation, turn / 2, 24), 2 * kEdge) << "left behind";
}

/// Two blobs that part from each other, each turning.
AnalyticScene parting() {
  AnalyticScene scene;
  scene.blobs = {round_blob({-0.6, 0, 0}, 0.7, 1), round_blob({0.6, 0.1, 0}, 0.8, 1)};
  scene.blobs[0].shape(1, 1) *= 1.6;
  scene.blobs[1].shape(2, 2) *= 0.7;
  scene.paths = {{{-0.5, 0, 0}, {0.2, 0, 0.1}, {-0.6, 0, 0}}, {{0.5, 0.1, 0}, {0, 0.3, 0}, {0.6, 0.1, 0}}};
  return scene;
}

TEST(AnalyticField, ASplitLeavesTwoPartsWithTheirOwnTexture) {
  const AnalyticScene scene = parting();
  for (const std::string method : {"rigid-global", "affine"}) {
    SCOPED_TRACE(method);
    Tracker tracker(settings_for(method), scene.field(0), 0);
    ASSERT_EQ(tracker.report().components, 1);
    constexpr int steps = 30;
    constexpr double duration = 3;
    for (int step = 1; step <= steps; ++step) {
      tracker.advance(AnalyticMotion(scene, duration * (step - 1) / steps, duration * step / steps));
      const auto fresh = extract_raw_surface(*scene.field(duration * step / steps), kEdge);
      EXPECT_TRUE(compare_surfaces(tracker.mesh().positions, tracker.mesh().triangles, fresh, std::pow(kEdge, 3))
                      .same_topology())
          << "step " << step;
    }
    EXPECT_EQ(tracker.report().components, 2);
    EXPECT_TRUE(mesh_problems(tracker.mesh()).empty());
    int astray = 0;
    for (std::size_t v = 0; v < tracker.mesh().positions.size(); ++v)
      astray += tracker.mesh().positions[v].x() * tracker.mesh().rest_positions[v].x() < 0 &&
                std::abs(tracker.mesh().rest_positions[v].x()) > 2 * kEdge;
    EXPECT_EQ(astray, 0) << "of " << tracker.mesh().positions.size() << " vertices";
  }
}

TEST(AnalyticField, SurfacesVanishAndAppear) {
  AnalyticScene none, some = bumpy(kTranslation);
  none.blobs = {round_blob({0, 0, 0}, 1, 0.2)};
  none.paths = {kTranslation};
  Tracker tracker(settings_for("affine"), none.field(0), 0);
  EXPECT_TRUE(tracker.mesh().positions.empty());
  tracker.advance(AnalyticMotion(some, 0, 1));
  EXPECT_EQ(tracker.report().components, 1);
  tracker.advance(AnalyticMotion(none, 1, 1.01));
  EXPECT_TRUE(tracker.mesh().positions.empty());
}

TEST(AnalyticField, AKeptStateGoesOnTheSameBitForBit) {
  const AnalyticScene scene = bumpy(kRotation);
  Tracker whole(settings_for("affine"), scene.field(0), 0);
  whole.advance(AnalyticMotion(scene, 0, 0.2));
  Tracker resumed(settings_for("affine"), scene.field(0.2), 0.2);
  resumed.restore(whole.state());
  whole.advance(AnalyticMotion(scene, 0.2, 0.4));
  resumed.advance(AnalyticMotion(scene, 0.2, 0.4));
  EXPECT_EQ(whole.mesh().positions, resumed.mesh().positions);
  EXPECT_EQ(whole.mesh().rest_positions, resumed.mesh().rest_positions);
  EXPECT_EQ(whole.mesh().velocities, resumed.mesh().velocities);
}

TEST(AnalyticField, WrongCallsAreRefused) {
  const AnalyticScene scene = bumpy(kRotation);
  Tracker tracker(settings_for("affine"), scene.field(0), 0);
  EXPECT_THROW(tracker.advance(AnalyticMotion(scene, 0.5, 1)), std::invalid_argument) << "it is at 0";
  EXPECT_THROW(tracker.advance(Particles{}), std::invalid_argument);
  TrackerSettings nothing;
  nothing.velocity = "affine";
  EXPECT_THROW(Tracker(nothing, scene.field(0), 0), std::invalid_argument) << "no edge length";
}

}  // namespace
}  // namespace flowskin::tracking::analytic_field_test
