#include "tracking/remeshing/remesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/tracking/mesh_test_shapes.h"
#include "tracking/extraction/extract_surface.h"
#include "tracking/field/metaballs/metaball_field.h"
#include "tracking/mesh/mesh_check.h"
#include "tracking/mesh/mesh_measures.h"

namespace flowskin::tracking::remesh_test {
namespace {

constexpr double kEdge = 0.75;  // spacing 1

/// A ball of particles and its surface, with a linear function of the place as rest position.
struct Ball {
  std::vector<Vec3> particles;
  MetaballField field;
  SurfaceMesh mesh;
};

Vec3 rest_of(const Vec3& x) { return Vec3(2 * x[0] - x[1], x[1] + 0.5 * x[2], 3 * x[2] + x[0]); }

Ball ball(double radius) {
  std::vector<Vec3> particles =
      test::lattice(1.0, int(radius) + 1, 0.05, 1, [&](const Vec3& x) { return x.norm() < radius; });
  MetaballField field(particles, {}, default_field_settings(1.0));
  const SurfaceGeometry surface = extract_surface(field, kEdge);
  SurfaceMesh mesh;
  mesh.positions = surface.positions;
  mesh.triangles = surface.triangles;
  for (const Vec3& x : mesh.positions) {
    mesh.rest_positions.push_back(rest_of(x));
    mesh.velocities.emplace_back(0, 0, 0);
    mesh.ids.push_back(mesh.next_id++);
  }
  return {std::move(particles), std::move(field), std::move(mesh)};
}

TEST(Remesh, LeavesAMeshThatNeedsNothingUntouched) {
  Ball body = ball(5.2);
  SurfaceMesh mesh = body.mesh;
  RemeshSettings loose;
  loose.edge_length = kEdge;
  loose.longest = 10;
  loose.shortest = 0;
  loose.delaunay_slack = 3;
  EXPECT_FALSE(remesh(body.field, loose, mesh).changed());
  EXPECT_EQ(mesh.positions, body.mesh.positions);
  EXPECT_EQ(mesh.triangles, body.mesh.triangles);
  EXPECT_EQ(mesh.ids, body.mesh.ids);
}

TEST(Remesh, BringsEdgesToAFinerAndACoarserTargetAndKeepsTheMeshSound) {
  for (const double target : {0.5 * kEdge, 1.6 * kEdge}) {
    Ball body = ball(5.2);
    SurfaceMesh mesh = body.mesh;
    const double volume = mesh_volume(mesh.positions, mesh.triangles);
    RemeshSettings settings;
    settings.edge_length = target;
    for (int pass = 0; pass < 8; ++pass) remesh(body.field, settings, mesh);
    EXPECT_EQ(test::joined(mesh_problems(mesh)), "");
    const MeshQuality quality = mesh_quality(mesh.positions, mesh.triangles);
    EXPECT_LT(quality.longest_edge, 1.6 * target);
    // Every edge may have any length within the limits, so the mean says little; but few may lie below them.
    EXPECT_GT(quality.mean_edge, settings.shortest * target);
    const std::vector<double> lengths =
        edge_lengths(build_adjacency(int(mesh.positions.size()), mesh.triangles), mesh.positions);
    const auto too_short = std::count_if(lengths.begin(), lengths.end(),
                                         [&](double length) { return length < settings.shortest * target; });
    EXPECT_LT(double(too_short), 0.02 * double(lengths.size()));
    EXPECT_NEAR(mesh_volume(mesh.positions, mesh.triangles), volume, 0.03 * volume);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
      EXPECT_LT(surface_distance(body.field, mesh.positions[v]).distance, 1e-6);
  }
}

TEST(Remesh, VerticesThatStayKeepAllTheyHave) {
  Ball body = ball(5.2);
  SurfaceMesh mesh = body.mesh;
  RemeshSettings settings;
  settings.edge_length = 1.3 * kEdge;
  const RemeshReport report = remesh(body.field, settings, mesh);
  ASSERT_GT(report.collapses, 10);
  int stayed = 0;
  for (std::size_t v = 0; v < mesh.ids.size(); ++v) {
    if (mesh.ids[v] >= body.mesh.next_id) continue;
    ++stayed;
    EXPECT_EQ(mesh.positions[v], body.mesh.positions[mesh.ids[v]]);
    EXPECT_EQ(mesh.rest_positions[v], body.mesh.rest_positions[mesh.ids[v]]);
  }
  EXPECT_EQ(stayed, int(body.mesh.ids.size()) - report.collapses);
}

TEST(Remesh, ANewVertexTakesTheMiddleOfItsEdge) {
  Ball body = ball(5.2);
  SurfaceMesh mesh = body.mesh;
  RemeshSettings settings;
  settings.edge_length = 0.6 * kEdge;
  settings.shortest = 0;
  const RemeshReport report = remesh(body.field, settings, mesh);
  ASSERT_GT(report.splits, 100);
  for (std::size_t v = body.mesh.ids.size(); v < mesh.ids.size(); ++v) {
    // The rest position is linear in the place, but the vertex was lifted from its edge onto the surface: by the
    // sagitta.
    EXPECT_LT((mesh.rest_positions[v] - rest_of(mesh.positions[v])).norm(), 4 * 0.25 * kEdge);
    EXPECT_EQ(mesh.ids[v], v);
  }
}

TEST(Remesh, SpringsOfEdgesThatStayKeepTheirRestLength) {
  Ball body = ball(5.2);
  SurfaceMesh mesh = body.mesh;
  const MeshAdjacency before = build_adjacency(int(mesh.positions.size()), mesh.triangles);
  std::vector<double> lengths(before.edges.size());
  for (std::size_t e = 0; e < lengths.size(); ++e) lengths[e] = 100 + double(e);
  RemeshSettings settings;
  settings.edge_length = 0.8 * kEdge;
  ASSERT_TRUE(remesh(body.field, settings, mesh).changed());
  const MeshAdjacency after = build_adjacency(int(mesh.positions.size()), mesh.triangles);
  const auto carried = carry_rest_lengths(body.mesh.ids, before, lengths, mesh, after, settings.edge_length);
  int kept = 0;
  for (std::size_t e = 0; e < carried.size(); ++e) {
    if (carried[e] < 100) {
      EXPECT_GE(carried[e], 0.7 * settings.edge_length - 1e-12);
      EXPECT_LE(carried[e], 1.3 * settings.edge_length + 1e-12);
      continue;
    }
    const auto old = std::size_t(carried[e] - 100);
    const std::array<std::uint64_t, 2> now{mesh.ids[after.edges[e][0]], mesh.ids[after.edges[e][1]]};
    const std::array<std::uint64_t, 2> then{body.mesh.ids[before.edges[old][0]], body.mesh.ids[before.edges[old][1]]};
    EXPECT_EQ(std::minmax(now[0], now[1]), std::minmax(then[0], then[1]));
    ++kept;
  }
  EXPECT_GT(kept, 100);
}

TEST(Remesh, TargetsFollowTheCurvature) {
  Ball body = ball(5.2);
  RemeshSettings settings;
  settings.edge_length = kEdge;
  EXPECT_TRUE(sizes_by_curvature(body.field, settings, body.mesh.positions).empty());
  // A ball of radius 5.6 or so, all over: its particles make bumps of a few per cent of that.
  settings.curvature = 0.1;
  const std::vector<double> sizes = sizes_by_curvature(body.field, settings, body.mesh.positions);
  double mean = 0, radius = 0;
  for (std::size_t v = 0; v < sizes.size(); ++v) {
    EXPECT_GE(sizes[v], settings.finest);
    EXPECT_LE(sizes[v], 1);
    mean += sizes[v] / double(sizes.size());
    radius += body.mesh.positions[v].norm() / double(sizes.size());
  }
  EXPECT_NEAR(mean, 0.1 * radius / kEdge, 0.15);
  SurfaceMesh fine = body.mesh, plain = body.mesh;
  for (int pass = 0; pass < 6; ++pass) {
    remesh(body.field, settings, fine);
    RemeshSettings same = settings;
    same.curvature = 0;
    remesh(body.field, same, plain);
  }
  EXPECT_EQ(test::joined(mesh_problems(fine)), "");
  EXPECT_GT(double(fine.positions.size()), 1.1 * double(plain.positions.size()));
}

}  // namespace
}  // namespace flowskin::tracking::remesh_test
