// What the tracked surface must survive: many turns, many rounds of remeshing, and particles that jump, vanish and
// appear.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/tracking/mesh_test_shapes.h"
#include "tests/tracking/welded_box.h"
#include "tracking/extraction/extract_surface.h"
#include "tracking/ground_truth/surface_comparison.h"
#include "tracking/mesh/mesh_check.h"
#include "tracking/mesh/self_intersections.h"
#include "tracking/remeshing/remesh.h"
#include "tracking/tracker.h"

namespace flowskin::tracking::endurance_test {
namespace {

using test::ball_of_particles;
using test::joined;
using test::particles_at;
using test::rigidly_moved;

TrackerSettings usual_settings() {
  TrackerSettings settings;
  settings.spacing = 1;
  return settings;
}

TEST(Endurance, ABodyTurnedTenTimesKeepsItsRestPositions) {
  std::vector<Vec3> body;
  for (const Vec3& x : ball_of_particles(4.2)) {
    if (x.y() < 1.5 && x.z() > -2.5) body.push_back(x);
  }
  TrackerSettings settings = usual_settings();
  settings.max_motion = 0.5;
  // The midpoint rule turns too far, by a sixth of the cube of each step's angle.
  settings.integrator = Integrator::rk4;
  const Vec3 spin(0.3, 1.1, -0.4);
  const double turn = 2 * std::numbers::pi / spin.norm();
  constexpr int kTurns = 10, kStates = 12;
  Tracker tracker(settings, rigidly_moved(body, spin, Vec3::Zero(), 0));
  int remeshed = 0;
  for (int k = 1; k <= kTurns * kStates; ++k) {
    tracker.advance(rigidly_moved(body, spin, Vec3::Zero(), turn * k / kStates));
    remeshed += tracker.report().splits + tracker.report().collapses + tracker.report().flips;
  }
  EXPECT_EQ(joined(mesh_problems(tracker.mesh())), "");
  // After whole turns every vertex should be where it was at rest.
  double worst = 0, sum = 0;
  const SurfaceMesh& mesh = tracker.mesh();
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const double error = (mesh.rest_positions[v] - mesh.positions[v]).norm();
    worst = std::max(worst, error);
    sum += error;
  }
  const double edge = tracker.settings().edge_length;
  RecordProperty("worst_in_edges", std::to_string(worst / edge));
  RecordProperty("mean_in_edges", std::to_string(sum / edge / double(mesh.positions.size())));
  RecordProperty("operations", remeshed);
  EXPECT_LT(worst, 0.02 * edge);
}

TEST(Endurance, ALinearAttributeSurvivesAHundredRoundsOfRandomRemeshing) {
  const auto attribute = [](const Vec3& x) {
    return Vec3(2 * x[0] - x[1] + 3, x[1] + 0.5 * x[2], x[0] - 7 * x[2] - 1);
  };
  const SurfaceGeometry box = test::welded_box(6);
  SurfaceMesh mesh;
  mesh.positions = box.positions;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> shift(-0.3, 0.3), target(0.6, 1.8), slack(0, 0.5);
  for (Vec3& x : mesh.positions) {
    // Each face stays flat, and the edges between them straight.
    for (double& coordinate : x) coordinate += coordinate > 0 && coordinate < 6 ? shift(random) : 0;
  }
  mesh.triangles = box.triangles;
  mesh.layers.emplace_back();
  for (const Vec3& x : mesh.positions) {
    mesh.rest_positions.push_back(attribute(x));
    mesh.layers[0].push_back(attribute(2 * x));
    mesh.velocities.push_back(attribute(-x));
    mesh.ids.push_back(mesh.next_id++);
  }
  RemeshReport sum;
  for (int round = 0; round < 100; ++round) {
    RemeshSettings settings;
    settings.edge_length = target(random);
    settings.delaunay_slack = slack(random);
    const RemeshReport done = remesh([](std::vector<Vec3>&) {}, settings, mesh);
    sum.splits += done.splits, sum.collapses += done.collapses, sum.flips += done.flips;
  }
  EXPECT_GT(sum.splits, 1000);
  EXPECT_GT(sum.collapses, 1000);
  EXPECT_GT(sum.flips, 100);
  EXPECT_EQ(joined(mesh_problems(mesh)), "");
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3& x = mesh.positions[v];
    EXPECT_LT((mesh.rest_positions[v] - attribute(x)).norm(), 1e-9);
    EXPECT_LT((mesh.layers[0][v] - attribute(2 * x)).norm(), 1e-9);
    EXPECT_LT((mesh.velocities[v] - attribute(-x)).norm(), 1e-9);
  }
}

/// A bar that is drawn out and turns.
Particles bar_at(double time) {
  Particles particles = particles_at(
      test::lattice(1.0, 8, 0.1, 3, [](const Vec3& x) { return std::abs(x.x()) < 7 && x.tail<2>().norm() < 3.2; }));
  particles.time = time;
  const Mat3 turn = test::rotation({0, 0.5 * time, 0.2 * time});
  for (std::size_t i = 0; i < particles.positions.size(); ++i) {
    const Vec3 x = particles.rest_positions[i];
    particles.positions[i] = turn * Vec3(x.x() * (1 + 0.1 * time), x.y(), x.z());
    particles.velocities[i] = turn * (Vec3(0, 0.5, 0.2).cross(particles.positions[i]));
  }
  return particles;
}

void keep(const std::vector<std::size_t>& which, Particles& particles) {
  const Particles all = particles;
  particles.ids.clear(), particles.positions.clear(), particles.velocities.clear(), particles.rest_positions.clear();
  for (std::size_t i : which) {
    particles.ids.push_back(all.ids[i]);
    particles.positions.push_back(all.positions[i]);
    particles.velocities.push_back(all.velocities[i]);
    particles.rest_positions.push_back(all.rest_positions[i]);
  }
}

void expect_survived(const Tracker& tracker, const Particles& particles) {
  const SurfaceMesh& mesh = tracker.mesh();
  EXPECT_EQ(joined(mesh_problems(mesh)), "");
  EXPECT_TRUE(self_intersections(mesh.positions, mesh.triangles).empty());
  EXPECT_FALSE(tracker.report().reextracted) << tracker.report().reason;
  EXPECT_LT(tracker.report().max_distance, 1e-3 * tracker.settings().field.radius);
  const SurfaceGeometry fresh = extract_raw_surface(MetaballField(particles.positions, {}, tracker.settings().field),
                                                    tracker.settings().edge_length);
  const SurfaceComparison comparison = compare_surfaces(mesh.positions, mesh.triangles, fresh);
  EXPECT_TRUE(comparison.same_topology());
  EXPECT_LT(comparison.hausdorff, 0.6 * tracker.settings().edge_length);
  EXPECT_LT(std::abs(comparison.volume_error()), 0.01);
}

TEST(Endurance, MissingFramesAreSurvived) {
  Tracker tracker(usual_settings(), bar_at(0));
  for (const double time : {0.1, 0.2, 1.4, 1.5, 3.5, 3.6}) {
    SCOPED_TRACE(time);
    tracker.advance(bar_at(time));
    expect_survived(tracker, bar_at(time));
  }
}

TEST(Endurance, TeleportingParticlesAreSurvivedAndOnlyTheirRegionIsReplaced) {
  Tracker tracker(usual_settings(), bar_at(0));
  tracker.advance(bar_at(0.1));
  const std::vector<std::uint64_t> before = tracker.mesh().ids;
  Particles particles = bar_at(0.2);
  // One end of the bar is suddenly elsewhere; a single particle swaps places with one at the other end.
  for (std::size_t i = 0; i < particles.positions.size(); ++i) {
    if (particles.rest_positions[i].x() > 4.5) particles.positions[i] += Vec3(0, 12, 0);
  }
  std::swap(particles.positions.front(), particles.positions[40]);
  tracker.advance(particles);
  expect_survived(tracker, particles);
  EXPECT_EQ(tracker.report().components, 2);
  EXPECT_GT(tracker.report().regions, 0);
  EXPECT_GT(tracker.report().born, 0);
  const std::vector<std::uint64_t>& after = tracker.mesh().ids;
  const auto kept = std::count_if(before.begin(), before.end(),
                                  [&](std::uint64_t id) { return std::count(after.begin(), after.end(), id) > 0; });
  EXPECT_GT(double(kept), 0.5 * double(before.size()));
}

TEST(Endurance, ParticlesThatVanishAndAppearAreSurvived) {
  Tracker tracker(usual_settings(), bar_at(0));
  std::mt19937 random(5);
  int regions = 0;
  for (int frame = 1; frame <= 8; ++frame) {
    SCOPED_TRACE(frame);
    Particles particles = bar_at(0.1 * frame);
    // In every frame another ball of particles is missing.
    const Vec3 center(std::uniform_real_distribution<double>(-6, 6)(random), 0, 2);
    std::vector<std::size_t> which;
    for (std::size_t i = 0; i < particles.ids.size(); ++i) {
      if ((particles.rest_positions[i] - center).norm() > 2.4) which.push_back(i);
    }
    keep(which, particles);
    tracker.advance(particles);
    regions += tracker.report().regions;
    expect_survived(tracker, particles);
  }
  EXPECT_GT(regions, 4);
}

}  // namespace
}  // namespace flowskin::tracking::endurance_test
