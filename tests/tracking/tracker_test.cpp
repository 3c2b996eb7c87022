// The tracker as a whole: rigid motion, merging, splitting, particles that come and go.
#include "tracking/tracker.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <stdexcept>

#include "tests/tracking/mesh_test_shapes.h"
#include "tracking/extraction/extract_surface.h"
#include "tracking/ground_truth/surface_comparison.h"
#include "tracking/mesh/mesh_check.h"
#include "tracking/mesh/mesh_measures.h"

namespace flowskin::tracking::tracker_test {
namespace {

using test::ball_of_particles;
using test::joined;
using test::particles_at;
using test::rigidly_moved;

TrackerSettings settings_for(const std::string& velocity) {
  TrackerSettings settings;
  settings.spacing = 1;
  settings.velocity = velocity;
  return settings;
}

void expect_written_well(const Tracker& tracker) {
  EXPECT_EQ(joined(mesh_problems(tracker.mesh())), "");
  const TrackerReport& report = tracker.report();
  EXPECT_LT(report.max_distance, 1e-3 * tracker.settings().field.radius);
}

SurfaceComparison compared_with_fresh(const Tracker& tracker, const Particles& particles) {
  const TrackerSettings& settings = tracker.settings();
  const SurfaceGeometry fresh =
      extract_raw_surface(MetaballField(particles.positions, {}, settings.field), settings.edge_length);
  return compare_surfaces(tracker.mesh().positions, tracker.mesh().triangles, fresh);
}

// An ellipsoid without symmetry to speak of.
std::vector<Vec3> ellipsoid() {
  return test::lattice(1.0, 8, 0.15, 4, [](const Vec3& x) { return x.cwiseQuotient(Vec3(6.5, 4.5, 3.5)).norm() <= 1; });
}

double root_mean_square_error(const SurfaceMesh& mesh, const Vec3& spin, const Vec3& drift, double t) {
  double sum = 0;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    sum += (mesh.positions[v] - (test::rotation(spin * t) * mesh.rest_positions[v] + drift * t)).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(mesh.positions.size()));
}

// The first mesh is one that remeshing leaves alone: fluid at rest keeps its vertices.
TEST(Tracker, FirstMeshIsAFixedPointOfRemeshing) {
  std::vector<Vec3> pool;
  for (const Vec3& x : test::lattice(1.0, 12, 0.2, 7, [](const Vec3& p) { return std::abs(p.y()) <= 4; }))
    pool.push_back(x);
  for (const std::vector<Vec3>& body : {pool, ellipsoid()}) {
    const Particles before = particles_at(body);
    Tracker tracker(settings_for("affine"), before);
    const std::vector<std::uint64_t> first = tracker.mesh().ids;
    Particles after = before;
    after.time = 1.0 / 30;
    tracker.advance(after);
    const auto count = static_cast<double>(tracker.mesh().ids.size());
    EXPECT_NEAR(count, static_cast<double>(first.size()), 0.02 * static_cast<double>(first.size()));
  }
}

TEST(Tracker, FirstMeshIsAtRest) {
  const Tracker tracker(settings_for("curvature"), particles_at(ball_of_particles(4.2)));
  expect_written_well(tracker);
  EXPECT_EQ(tracker.mesh().positions, tracker.mesh().rest_positions);
  EXPECT_EQ(tracker.report().components, 1);
  EXPECT_FALSE(tracker.report().reextracted);
  EXPECT_DOUBLE_EQ(tracker.settings().edge_length, 0.75);
  EXPECT_GT(tracker.settings().field.radius, 0);
}

TEST(Tracker, FollowsATranslationWithoutTheGuard) {
  const std::vector<Vec3> start = ellipsoid();
  const Vec3 none = Vec3::Zero(), drift(3, -2, 1);
  for (const char* method : {"total", "curvature"}) {
    TrackerSettings settings = settings_for(method);
    settings.fairing_iterations = 0;
    settings.remeshing = false;
    Tracker tracker(settings, rigidly_moved(start, none, drift, 0));
    const std::vector<std::uint64_t> ids = tracker.mesh().ids;
    for (int frame = 1; frame <= 4; ++frame) {
      tracker.advance(rigidly_moved(start, none, drift, 0.25 * frame));
      EXPECT_FALSE(tracker.report().reextracted) << tracker.report().reason;
      EXPECT_GE(tracker.report().substeps, 2);
      expect_written_well(tracker);
    }
    EXPECT_EQ(tracker.mesh().ids, ids);
    EXPECT_LT(root_mean_square_error(tracker.mesh(), none, drift, 1), 1e-3);
    for (const Vec3& velocity : tracker.mesh().velocities) EXPECT_LT((velocity - drift).norm(), 1e-3 * drift.norm());
  }
}

TEST(Tracker, CurvatureFollowsARotationBetterThanNormal) {
  const std::vector<Vec3> start = ellipsoid();
  const Vec3 spin(0.3, 0.2, 1), drift(0.5, 0, 0);
  std::vector<double> errors;
  for (const char* method : {"curvature", "normal"}) {
    Tracker tracker(settings_for(method), rigidly_moved(start, spin, drift, 0));
    for (int frame = 1; frame <= 5; ++frame) {
      tracker.advance(rigidly_moved(start, spin, drift, 0.1 * frame));
      expect_written_well(tracker);
    }
    errors.push_back(root_mean_square_error(tracker.mesh(), spin, drift, 0.5));
  }
  EXPECT_LT(errors[0], 0.2);
  EXPECT_LT(errors[0], 0.3 * errors[1]);
}

TEST(Tracker, IntegratorsAgreeInTheLimit) {
  const std::vector<Vec3> start = ellipsoid();
  const Vec3 spin(0, 0, 1), drift(0, 0, 0);
  std::vector<std::vector<Vec3>> ends;
  for (const Integrator integrator : {Integrator::euler, Integrator::rk2, Integrator::rk4}) {
    TrackerSettings settings = settings_for("total");
    settings.fairing_iterations = 0;
    settings.remeshing = false;
    settings.max_motion = 0.05;
    settings.integrator = integrator;
    Tracker tracker(settings, rigidly_moved(start, spin, drift, 0));
    tracker.advance(rigidly_moved(start, spin, drift, 0.1));
    ends.push_back(tracker.mesh().positions);
  }
  double euler = 0, midpoint = 0;
  for (std::size_t v = 0; v < ends[0].size(); ++v) {
    euler += (ends[0][v] - ends[2][v]).squaredNorm();
    midpoint += (ends[1][v] - ends[2][v]).squaredNorm();
  }
  EXPECT_GT(euler, 0);
  EXPECT_LT(std::sqrt(euler / static_cast<double>(ends[0].size())), 0.02);
  EXPECT_LT(midpoint, 0.1 * euler);  // the total velocity has places where it is not smooth
}

// Two balls on the x axis at +-distance / 2.
Particles two_balls(double distance, double time, double approach) {
  std::vector<Vec3> points = ball_of_particles(3.2, {-distance / 2, 0, 0});
  const std::size_t half = points.size();
  for (const Vec3& x : ball_of_particles(3.2, {distance / 2, 0.3, 0}, 5)) points.push_back(x);
  Particles particles = particles_at(points);
  particles.time = time;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double side = i < half ? 1 : -1;
    particles.velocities[i] = side * Vec3(approach / 2, 0, 0);
    particles.rest_positions[i] -= side * Vec3(approach / 2 * time, 0, 0);
  }
  return particles;
}

TEST(Tracker, BallsMergeAndPartAgain) {
  for (const double direction : {1.0, -1.0}) {
    const double start = direction > 0 ? 9.5 : 6.0;
    Tracker tracker(settings_for("curvature"), two_balls(start, 0, direction * 3.5));
    EXPECT_EQ(tracker.report().components, direction > 0 ? 2 : 1);
    int replaced = 0, other_topology = 0;
    for (int frame = 1; frame <= 10; ++frame) {
      const Particles particles = two_balls(start - direction * 0.35 * frame, 0.1 * frame, direction * 3.5);
      tracker.advance(particles);
      expect_written_well(tracker);
      const SurfaceComparison comparison = compared_with_fresh(tracker, particles);
      EXPECT_LT(std::abs(comparison.volume_error()), 0.01);
      const bool is_same = comparison.same_topology();
      EXPECT_LT(comparison.hausdorff, (is_same ? 0.5 : 1.0) * tracker.settings().edge_length);
      other_topology += !is_same;
      replaced += tracker.report().regions;
      EXPECT_FALSE(tracker.report().reextracted) << tracker.report().reason;
    }
    EXPECT_EQ(tracker.report().components, direction > 0 ? 1 : 2);
    EXPECT_GE(replaced, 1);
    EXPECT_LE(other_topology, 1);  // while the neck is thinner than a cell it may be there or not
    // Material stays with its ball: nothing is blended between them.
    for (std::size_t v = 0; v < tracker.mesh().positions.size(); ++v) {
      const Vec3& rest = tracker.mesh().rest_positions[v];
      EXPECT_LT((rest - Vec3(rest[0] < 0 ? -start / 2 : start / 2, 0, 0)).norm(), 3.2 + 1.6);
    }
  }
}

TEST(Tracker, ParticlesComeAndGo) {
  Particles none;
  Tracker tracker(settings_for("curvature"), none);
  EXPECT_TRUE(tracker.mesh().positions.empty());
  tracker.advance(none);
  EXPECT_FALSE(tracker.report().reextracted);

  Particles ball = particles_at(ball_of_particles(4.2));
  ball.time = 0.1;
  tracker.advance(ball);
  EXPECT_EQ(tracker.report().reason, "a surface appeared");
  expect_written_well(tracker);
  const std::uint64_t next_id = tracker.mesh().next_id;

  Particles more = particles_at(ball_of_particles(4.2));
  more.time = 0.2;
  for (const Vec3& x : ball_of_particles(3.2, {11, 0, 0})) {
    more.ids.push_back(more.ids.size());
    more.positions.push_back(x);
    more.rest_positions.push_back(x);
    more.velocities.emplace_back(0, 0, 0);
  }
  tracker.advance(more);
  EXPECT_EQ(tracker.report().components, 2);
  EXPECT_EQ(tracker.report().regions, 1);
  EXPECT_FALSE(tracker.report().reextracted) << tracker.report().reason;
  expect_written_well(tracker);
  EXPECT_TRUE(compared_with_fresh(tracker, more).same_topology());

  none.time = 0.3;
  tracker.advance(none);
  EXPECT_EQ(tracker.report().reason, "the surface vanished");
  EXPECT_TRUE(tracker.mesh().positions.empty());
  EXPECT_EQ(joined(mesh_problems(tracker.mesh())), "");

  ball.time = 0.4;
  tracker.advance(ball);
  EXPECT_GT(*std::min_element(tracker.mesh().ids.begin(), tracker.mesh().ids.end()), next_id);
}

TEST(Tracker, ParticlesWithoutASurfaceAreNoError) {
  Tracker tracker(settings_for("normal"), particles_at({{0, 0, 0}, {9, 0, 0}}));
  EXPECT_TRUE(tracker.mesh().positions.empty());
  tracker.advance(particles_at({{0, 1, 0}, {9, 1, 0}}));
  EXPECT_TRUE(tracker.mesh().positions.empty());
}

TEST(Tracker, SameBytesAtAnyThreadCount) {
  const int threads = omp_get_max_threads();
  std::vector<SurfaceMesh> ends;
  for (const int count : {1, 3}) {
    omp_set_num_threads(count);
    Tracker tracker(settings_for("curvature"), two_balls(8.5, 0, 3.5));
    for (int frame = 1; frame <= 4; ++frame) tracker.advance(two_balls(8.5 - 0.35 * frame, 0.1 * frame, 3.5));
    ends.push_back(tracker.mesh());
  }
  omp_set_num_threads(threads);
  EXPECT_EQ(ends[0].positions, ends[1].positions);
  EXPECT_EQ(ends[0].rest_positions, ends[1].rest_positions);
  EXPECT_EQ(ends[0].velocities, ends[1].velocities);
  EXPECT_EQ(ends[0].triangles, ends[1].triangles);
  EXPECT_EQ(ends[0].ids, ends[1].ids);
}

TEST(Tracker, RefusesImpossibleSettings) {
  const Particles particles = particles_at({{0, 0, 0}});
  const auto refused = [&](auto change) {
    TrackerSettings settings = settings_for("normal");
    change(settings);
    EXPECT_THROW(Tracker(settings, particles), std::invalid_argument);
  };
  refused([](TrackerSettings& s) { s.spacing = 0; });
  refused([](TrackerSettings& s) { s.spacing = std::nan(""); });
  refused([](TrackerSettings& s) { s.edge_length = -1; });
  refused([](TrackerSettings& s) { s.max_motion = 0; });
  refused([](TrackerSettings& s) { s.fairing_iterations = -1; });
  refused([](TrackerSettings& s) { s.fairing_stiffness = 1.5; });
  refused([](TrackerSettings& s) { s.field = {-1, 0.5, 1}; });
  refused([](TrackerSettings& s) { s.field = {1, 0, 1}; });
  refused([](TrackerSettings& s) { s.field.wall_share = 0.6; });
}

TEST(Tracker, RefusesBadParticlesAndStaysAsItWas) {
  const Particles good = particles_at(ball_of_particles(3.2));
  Tracker tracker(settings_for("normal"), good);
  Particles bad = good;
  bad.positions[5][0] = std::nan("");
  const std::vector<Vec3> before = tracker.mesh().positions;
  EXPECT_THROW(tracker.advance(bad), std::invalid_argument);
  EXPECT_EQ(tracker.mesh().positions, before);
  EXPECT_NO_THROW(tracker.advance(good));
}

}  // namespace
}  // namespace flowskin::tracking::tracker_test
