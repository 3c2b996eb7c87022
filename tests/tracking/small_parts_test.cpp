// Drops and bubbles below a size are kept, dropped, or made balls.
#include "tracking/repair/small_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/tracking/mesh_test_shapes.h"
#include "tracking/mesh/mesh_check.h"
#include "tracking/mesh/mesh_measures.h"
#include "tracking/tracker.h"

namespace flowskin::tracking::small_parts_test {
namespace {

using test::ball_of_particles;
using test::joined;
using test::particles_at;

constexpr double kSmall = 100;  // m^3; spacing 1

/// A large ball and beside it a drop that is no ball.
Particles ball_and_drop(double time) {
  std::vector<Vec3> points = ball_of_particles(4.2);
  for (const Vec3& x : ball_of_particles(2.1)) {
    if (x.y() > -0.5) points.push_back(x + Vec3(9 + 0.3 * time, 0, 0));
  }
  Particles particles = particles_at(points);
  particles.time = time;
  return particles;
}

/// A ball with air inside.
Particles hollow_ball(double time) {
  std::vector<Vec3> points;
  for (const Vec3& x : ball_of_particles(6.3)) {
    if (x.norm() >= 3) points.push_back(x);
  }
  Particles particles = particles_at(points);
  particles.time = time;
  return particles;
}

Tracker tracked(Particles (*particles)(double), SmallParts small_parts, int calls = 4) {
  TrackerSettings settings;
  settings.spacing = 1;
  settings.smallest_part = kSmall;
  settings.small_parts = small_parts;
  Tracker tracker(settings, particles(0));
  for (int call = 1; call <= calls; ++call) tracker.advance(particles(0.1 * call));
  EXPECT_EQ(joined(mesh_problems(tracker.mesh())), "");
  EXPECT_FALSE(tracker.report().reextracted) << tracker.report().reason;
  return tracker;
}

/// Number of the component that encloses least, either way round.
int smallest(const MeshComponents& components) {
  return static_cast<int>(std::min_element(components.volumes.begin(), components.volumes.end(),
                                           [](double a, double b) { return std::abs(a) < std::abs(b); }) -
                          components.volumes.begin());
}

TEST(SmallParts, StayUnlessTheyAreUnwanted) {
  EXPECT_EQ(tracked(ball_and_drop, SmallParts::keep).report().components, 2);
  EXPECT_EQ(tracked(hollow_ball, SmallParts::keep).report().components, 2);
}

TEST(SmallParts, AreDropped_FluidAndAir) {
  for (auto* particles : {ball_and_drop, hollow_ball}) {
    const Tracker all = tracked(particles, SmallParts::keep), tracker = tracked(particles, SmallParts::drop);
    EXPECT_EQ(tracker.report().components, 1);
    const MeshComponents parts = mesh_components(all.mesh().positions, all.mesh().triangles);
    const double small = parts.volumes[smallest(parts)];
    ASSERT_LT(std::abs(small), kSmall);
    EXPECT_NEAR(tracker.report().volume, all.report().volume - small, 1e-3 * tracker.report().volume);
  }
}

TEST(SmallParts, BecomeBallsOfTheSameVolumeAndStayThem) {
  for (auto* particles : {ball_and_drop, hollow_ball}) {
    const Tracker all = tracked(particles, SmallParts::keep);
    const Tracker once = tracked(particles, SmallParts::balls, 1), tracker = tracked(particles, SmallParts::balls);
    EXPECT_EQ(tracker.report().balls, 1);
    const SurfaceMesh& mesh = tracker.mesh();
    const MeshComponents parts = mesh_components(mesh.positions, mesh.triangles);
    ASSERT_EQ(parts.count, 2);
    const MeshComponents as_they_are = mesh_components(all.mesh().positions, all.mesh().triangles);
    const double volume = as_they_are.volumes[smallest(as_they_are)];
    EXPECT_NEAR(parts.volumes[smallest(parts)], volume, 0.02 * std::abs(volume));
    Vec3 center = Vec3::Zero();
    double count = 0;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      if (parts.of_vertex[v] != smallest(parts)) continue;
      center += mesh.positions[v];
      ++count;
    }
    center /= count;
    double least = 1e9, most = 0, kept = 0;
    const std::vector<std::uint64_t>& before = once.mesh().ids;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      if (parts.of_vertex[v] != smallest(parts)) continue;
      const double distance = (mesh.positions[v] - center).norm();
      least = std::min(least, distance), most = std::max(most, distance);
      kept += double(std::count(before.begin(), before.end(), mesh.ids[v]));
    }
    // Not exactly around the mean of their vertices: that is where the ball was made from.
    EXPECT_LT(most - least, 0.15 * most);
    EXPECT_GT(kept, 0.8 * count);
  }
}

TEST(SmallParts, MakeBallKeepsVolumeAndPutsVerticesOnASphere) {
  SurfaceGeometry surface = test::tetrahedron();
  const double volume = mesh_volume(surface.positions, surface.triangles);
  const Vec3 center(0.25, 0.25, 0.25);
  ASSERT_TRUE(make_ball({0, 1, 2, 3}, surface.triangles, volume, surface.positions));
  EXPECT_NEAR(mesh_volume(surface.positions, surface.triangles), volume, 1e-12);
  for (const Vec3& x : surface.positions)
    EXPECT_NEAR((x - center).norm(), (surface.positions[0] - center).norm(), 1e-12);
}

TEST(SmallParts, MakeBallLeavesARingAsItIs) {
  const auto torus = [](const Vec3& x) { return 0.4 - std::hypot(std::hypot(x.x(), x.y()) - 1, x.z()); };
  const SurfaceGeometry before = test::marched(torus, 1.5, 0.2);
  SurfaceGeometry surface = before;
  std::vector<int> all;
  for (std::size_t v = 0; v < surface.positions.size(); ++v) all.push_back(static_cast<int>(v));
  EXPECT_FALSE(make_ball(all, surface.triangles, mesh_volume(surface.positions, surface.triangles), surface.positions));
  EXPECT_EQ(surface.positions, before.positions);
}

}  // namespace
}  // namespace flowskin::tracking::small_parts_test
