// Markers and the errors of a mesh against them, where the truth is known by another route.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "tests/tracking/field_test_bodies.h"
#include "tracking/advection/projection.h"
#include "tracking/ground_truth/markers.h"
#include "tracking/ground_truth/mesh_errors.h"
#include "tracking/tracker.h"

namespace flowskin::tracking::ground_truth_test {
namespace {

using test::lattice;
using test::velocities_of;

constexpr double spacing = 0.1;
const Vec3 spin(0.4, 1.1, -0.6);

Vec3 turning(const Vec3& x) { return spin.cross(x) + Vec3(0.3, -0.2, 0.5); }

/// Where `turning` carries what is at x at time 0: a turn about a centre that moves on along the axis.
Vec3 moved(const Vec3& x, double time) {
  const Vec3 shift = turning(Vec3::Zero());
  const Vec3 along = spin * spin.dot(shift) / spin.squaredNorm();
  const Vec3 center = spin.cross(shift) / spin.squaredNorm();
  return center + Eigen::AngleAxisd(time * spin.norm(), spin.normalized()) * (x - center) + along * time;
}

/// A ball of particles that turns and moves on.
Particles body_at(double time) {
  Particles particles;
  particles.time = time;
  particles.rest_positions = lattice(spacing, 5, 0.2, 91, [](const Vec3& x) { return x.norm() < 0.42; });
  for (const Vec3& rest : particles.rest_positions) {
    particles.ids.push_back(particles.ids.size());
    particles.positions.push_back(moved(rest, time));
  }
  particles.velocities = velocities_of(particles.positions, turning);
  return particles;
}

SurfaceMesh mesh_of(const Particles& particles) {
  TrackerSettings settings;
  settings.spacing = spacing;
  return Tracker(settings, particles).mesh();
}

MetaballField field_of(const Particles& particles) {
  return {particles.positions, particles.velocities, default_field_settings(spacing)};
}

TEST(Markers, RideARigidBodyExactly) {
  Particles now = body_at(0);
  Markers markers = start_markers(mesh_of(now), 0, 100000);
  const std::vector<Vec3> start = markers.positions;
  for (int k = 1; k <= 20; ++k) {
    const Particles next = body_at(0.05 * k);
    const ParticlePaths paths(now, next);
    advect_markers(particle_flow(paths, default_field_settings(spacing)), next.time, 2, markers);
    now = next;
  }
  EXPECT_EQ(markers.time, 1.0);
  for (std::size_t i = 0; i < start.size(); ++i) EXPECT_LT((markers.positions[i] - moved(start[i], 1)).norm(), 1e-6);
  settle_markers(field_of(now), spacing, markers);
  EXPECT_EQ(markers.on_surface(), int(start.size()));
  for (const double depth : markers.depths) EXPECT_LT(depth, 1e-5);
}

TEST(Markers, ConvergeWithTheFourthPower) {
  const FlowAt vortex = [](double time) -> Flow {
    return [time](const Vec3& x) {
      return Vec3(std::sin(3 * x.y() + time), std::cos(2 * x.x() - time), std::sin(x.x() + 2 * x.y()));
    };
  };
  const auto end = [&](int steps) {
    Markers markers = start_markers(mesh_of(body_at(0)), 0, 20);
    advect_markers(vortex, 1, steps, markers);
    return markers.positions;
  };
  const auto distance = [](const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]).squaredNorm();
    return std::sqrt(sum);
  };
  const std::vector<Vec3> truth = end(512);
  const double coarse = distance(end(8), truth), fine = distance(end(16), truth);
  EXPECT_GT(coarse / fine, 12);
  EXPECT_LT(coarse / fine, 22);
}

TEST(Markers, AreAtMostAsManyAsWantedAndSpreadOverTheMesh) {
  const SurfaceMesh mesh = mesh_of(body_at(0));
  const Markers few = start_markers(mesh, 0, 50);
  EXPECT_LE(few.ids.size(), 50U);
  EXPECT_GE(few.ids.size(), 25U);
  Vec3 low = few.positions[0], high = low;
  for (const Vec3& x : few.positions) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  EXPECT_GT((high - low).minCoeff(), 0.7);
  EXPECT_TRUE(start_markers({}, 0, 50).ids.empty());
}

TEST(Markers, LeaveWhenTheyAreNoLongerAtTheSurface) {
  const Particles body = body_at(0);
  Markers markers = start_markers(mesh_of(body), 0, 100000);
  const int count = markers.on_surface();
  markers.positions[0] = Vec3::Zero();   // deep inside
  markers.positions[1] = Vec3(5, 0, 0);  // far outside
  markers.positions[2] *= 1.02;          // a little outside
  settle_markers(field_of(body), spacing, markers);
  EXPECT_EQ(markers.on_surface(), count - 2);
  EXPECT_EQ(markers.left[2], 0);
  const Vec3 where = markers.positions[0];
  advect_markers([](double) -> Flow { return [](const Vec3&) { return Vec3(1, 0, 0); }; }, 1, 1, markers);
  EXPECT_EQ(markers.positions[0], where);
  settle_markers(field_of(body), 100, markers);
  EXPECT_EQ(markers.left[0], 1);
}

TEST(MeshErrors, AreZeroWhereTheMeshMovedWithItsMaterialAndKnownWhereItSlipped) {
  SurfaceMesh mesh = mesh_of(body_at(0));
  Markers markers = start_markers(mesh, 0, 100000);
  for (Vec3& x : markers.positions) x = moved(x, 1);
  settle_markers(field_of(body_at(1)), spacing, markers);
  SurfaceMesh moved_mesh = mesh;
  for (Vec3& x : moved_mesh.positions) x = moved(x, 1);
  const MarkerErrors none = marker_errors(moved_mesh, markers, 2 * spacing);
  EXPECT_LT(none.texture.p90, 1e-9);
  EXPECT_LT(none.path.p90, 1e-9);
  EXPECT_LT(none.vertex_path.p90, 1e-12);
  EXPECT_EQ(none.texture_found, 1);
  EXPECT_EQ(none.path_found, 1);
  EXPECT_EQ(none.vertices_kept, 1);

  // The same surface, but everything on it has been turned by a small angle: like a method that lags behind.
  const double angle = 0.1;
  const Eigen::AngleAxisd lag(angle, Vec3::UnitY());
  SurfaceMesh lagging = mesh;
  for (Vec3& x : lagging.positions) x = moved(lag * x, 1);
  const MarkerErrors some = marker_errors(lagging, markers, 2 * spacing);
  // On a ball of radius about 0.47 the mean distance from the axis is pi/4 of the radius.
  const double expected = angle * 0.47 * std::numbers::pi / 4;
  EXPECT_NEAR(some.vertex_path.rms, angle * 0.47 * std::sqrt(2.0 / 3), 0.15 * expected);
  EXPECT_NEAR(some.path.rms, some.vertex_path.rms, 0.1 * expected);
  EXPECT_NEAR(some.texture.rms, some.vertex_path.rms, 0.15 * expected);
  EXPECT_LT(some.texture.median, some.texture.p90);
}

TEST(MeshErrors, AVertexOfOtherMaterialIsNotFollowedAndAnAbsentMeshFindsNothing) {
  SurfaceMesh mesh = mesh_of(body_at(0));
  Markers markers = start_markers(mesh, 0, 100000);
  settle_markers(field_of(body_at(0)), spacing, markers);
  const auto count = double(markers.ids.size());
  mesh.rest_positions[0] += Vec3(0.01, 0, 0);  // now other material
  mesh.ids[1] = mesh.next_id++;                // another vertex
  EXPECT_NEAR(marker_errors(mesh, markers, 2 * spacing).vertices_kept, 1 - 2 / count, 1e-12);
  const MarkerErrors nothing = marker_errors({}, markers, 2 * spacing);
  EXPECT_EQ(nothing.texture_found, 0);
  EXPECT_EQ(nothing.texture.median, 0);
  EXPECT_EQ(marker_errors(mesh, {}, 2 * spacing).texture_found, 0);
}

TEST(MeshErrors, VelocityErrorsAreOfTheRightSize) {
  SurfaceMesh mesh = mesh_of(body_at(0));
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) mesh.velocities[v] = turning(mesh.positions[v]);
  const VelocityErrors none = velocity_errors(mesh, particle_flow(field_of(body_at(0))));
  EXPECT_LT(none.error, 1e-16 * none.flow);
  EXPECT_GT(none.tangential_flow, 0.5 * none.flow);
  EXPECT_LT(none.tangential_flow, none.flow);
  // A ball moving with (1, 0, 0) whose mesh stands still: all of the flow is error; two thirds of it tangential.
  for (Vec3& v : mesh.velocities) v.setZero();
  const VelocityErrors all = velocity_errors(mesh, [](const Vec3&) { return Vec3(1, 0, 0); });
  EXPECT_NEAR(all.error, 1, 1e-12);
  EXPECT_NEAR(all.tangential_error, 2.0 / 3, 0.03);
  EXPECT_NEAR(all.tangential_flow, all.tangential_error, 1e-12);
  EXPECT_EQ(velocity_errors({}, [](const Vec3&) { return Vec3(1, 0, 0); }).error, 0);
}

}  // namespace
}  // namespace flowskin::tracking::ground_truth_test
