// Adjacency, measures, edge operations and closest points of meshes.
#include "tracking/mesh/mesh_measures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "common/closest_point.h"
#include "tests/tracking/mesh_test_shapes.h"
#include "tracking/mesh/editable_mesh.h"
#include "tracking/mesh/mesh_check.h"

namespace flowskin::tracking::mesh_measures_test {
namespace {

using std::numbers::pi;
using test::both;
using test::joined;
using test::marched;
using test::tetrahedron;

double ball(const Vec3& x) { return 1 - x.norm(); }
double torus(const Vec3& x) {
  const double ring = std::hypot(x[0], x[1]) - 1;
  return 0.4 - std::hypot(ring, x[2]);
}

TEST(MeshAdjacency, OfATetrahedron) {
  const MeshAdjacency topology = build_adjacency(4, tetrahedron().triangles);
  EXPECT_EQ(topology.edges.size(), 6U);
  for (int v = 0; v < 4; ++v) {
    EXPECT_EQ(topology.star(v).size(), 3U);
    EXPECT_EQ(topology.ring(v).size(), 3U);
  }
  for (std::size_t e = 0; e < 6; ++e) {
    const auto& [a, b] = topology.edges[e];
    EXPECT_LT(a, b);
    EXPECT_NE(topology.edge_triangles[e][0], topology.edge_triangles[e][1]);
    for (int t : topology.edge_triangles[e]) {
      const Triangle triangle = tetrahedron().triangles[t];
      EXPECT_EQ(std::count(triangle.begin(), triangle.end(), a) + std::count(triangle.begin(), triangle.end(), b), 2);
    }
  }
}

TEST(MeshAdjacency, RingsAscendAndNameTheirEdges) {
  const SurfaceGeometry surface = marched(ball, 1, 0.2);
  const MeshAdjacency topology = build_adjacency(static_cast<int>(surface.positions.size()), surface.triangles);
  EXPECT_TRUE(std::is_sorted(topology.edges.begin(), topology.edges.end()));
  for (int v = 0; v < topology.vertex_count(); ++v) {
    int last = -1;
    for (const auto& [other, edge] : topology.ring(v)) {
      EXPECT_GT(other, last);
      last = other;
      EXPECT_EQ(topology.edges[edge][0], std::min(v, other));
      EXPECT_EQ(topology.edges[edge][1], std::max(v, other));
    }
  }
}

TEST(MeshMeasures, OfATetrahedronFarFromTheOrigin) {
  SurfaceGeometry surface = tetrahedron();
  for (Vec3& x : surface.positions) x += Vec3(1e6, -1e6, 1e6);
  EXPECT_NEAR(mesh_volume(surface.positions, surface.triangles), 1.0 / 6, 1e-12);
  EXPECT_NEAR(mesh_area(surface.positions, surface.triangles), 1.5 + std::sqrt(3.0) / 2, 1e-12);
}

TEST(MeshMeasures, ComponentsAndGenus) {
  const SurfaceGeometry two = both(marched(ball, 1, 0.2), marched(torus, 1.5, 0.1));
  const MeshComponents components = mesh_components(two.positions, two.triangles);
  ASSERT_EQ(components.count, 2);
  EXPECT_NEAR(components.volumes[0], 4 * pi / 3, 0.1);
  EXPECT_NEAR(components.volumes[1], 2 * pi * pi * 0.16, 0.1);
  EXPECT_EQ(euler_characteristic(two.positions, two.triangles), 2);  // 2 of the ball, 0 of the torus
}

TEST(MeshMeasures, QualityOfAnEquilateralShape) {
  const std::vector<Vec3> positions = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  const std::vector<Triangle> triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
  const MeshQuality quality = mesh_quality(positions, triangles);
  EXPECT_NEAR(quality.smallest_angle, pi / 3, 1e-12);
  EXPECT_NEAR(quality.mean_smallest_angle, pi / 3, 1e-12);
  EXPECT_NEAR(quality.shortest_edge, std::sqrt(8.0), 1e-12);
  EXPECT_NEAR(quality.longest_edge, std::sqrt(8.0), 1e-12);
}

TEST(MeshMeasures, NormalsOfABall) {
  const SurfaceGeometry surface = marched(ball, 1, 0.1);
  const std::vector<Vec3> normals = vertex_normals(surface.positions, surface.triangles);
  for (std::size_t v = 0; v < normals.size(); ++v) {
    EXPECT_GT(normals[v].dot(surface.positions[v].normalized()), 0.99);
  }
}

TEST(EditableMesh, AnyCollapsesAndFlipsKeepAMeshSound) {
  SurfaceGeometry surface = marched(torus, 1.5, 0.15);
  const int before = static_cast<int>(surface.positions.size());
  const MeshAdjacency topology = build_adjacency(before, surface.triangles);
  EditableMesh mesh(surface.positions, surface.triangles);
  int collapses = 0, flips = 0;
  for (std::size_t e = 0; e < topology.edges.size(); ++e) {
    const auto& [a, b] = topology.edges[e];
    if (e % 3 == 0) collapses += mesh.collapse(b, a, 0.4) ? 1 : 0;
    if (e % 3 == 1) flips += mesh.flip(a, b) ? 1 : 0;
  }
  mesh.compact();
  EXPECT_GT(collapses, 100);
  EXPECT_GT(flips, 100);
  EXPECT_EQ(static_cast<int>(surface.positions.size()), before - collapses);
  EXPECT_EQ(joined(mesh_problems(surface.positions, surface.triangles)), "");
  EXPECT_EQ(euler_characteristic(surface.positions, surface.triangles), 0);
  EXPECT_NEAR(mesh_volume(surface.positions, surface.triangles), 2 * pi * pi * 0.16, 0.15 * 2 * pi * pi * 0.16);
}

TEST(EditableMesh, RefusesToDestroyATetrahedron) {
  SurfaceGeometry surface = tetrahedron();
  EditableMesh mesh(surface.positions, surface.triangles);
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 4; ++b) {
      EXPECT_FALSE(mesh.collapse(a, b, 100));
      EXPECT_FALSE(a != b && mesh.flip(a, b));
    }
  }
}

// Distance to a triangle by sampling it densely.
double sampled_distance(const Vec3& x, const SurfaceGeometry& surface, const Triangle& triangle) {
  constexpr int n = 60;
  double best = std::numeric_limits<double>::max();
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; i + j <= n; ++j) {
      const Vec3 y = (i * surface.positions[triangle[0]] + j * surface.positions[triangle[1]] +
                      (n - i - j) * surface.positions[triangle[2]]) /
                     n;
      best = std::min(best, (x - y).norm());
    }
  }
  return best;
}

TEST(ClosestPoint, AgreesWithBruteForce) {
  const SurfaceGeometry surface = marched(torus, 1.5, 0.3);
  const ClosestPointTree tree(surface.positions, surface.triangles);
  test::Random random(5);
  for (int query = 0; query < 60; ++query) {
    const Vec3 x = 1.6 * random.vector();
    double expected = std::numeric_limits<double>::max();
    for (const Triangle& triangle : surface.triangles) {
      expected = std::min(expected, sampled_distance(x, surface, triangle));
    }
    const MeshPoint found = tree.closest(x, 10);
    ASSERT_GE(found.triangle, 0);
    EXPECT_LE(found.distance, expected + 1e-12);
    EXPECT_GE(found.distance, expected - 0.01);
    Vec3 place = Vec3::Zero();
    double sum = 0;
    for (int corner = 0; corner < 3; ++corner) {
      EXPECT_GE(found.weights[corner], 0);
      sum += found.weights[corner];
      place += found.weights[corner] * surface.positions[surface.triangles[found.triangle][corner]];
    }
    EXPECT_NEAR(sum, 1, 1e-12);
    EXPECT_NEAR((place - x).norm(), found.distance, 1e-12);
    EXPECT_LT(tree.closest(x, 0.9 * found.distance).triangle, 0);
  }
}

TEST(ClosestPoint, LooksAtTheSideAskedFor) {
  const SurfaceGeometry surface = marched(ball, 1, 0.2);
  const ClosestPointTree tree(surface.positions, surface.triangles);
  const MeshPoint opposite = tree.closest({0, 0, 0.9}, 10, {0, 0, -1}, 0.3);
  ASSERT_GE(opposite.triangle, 0);
  EXPECT_LT(doubled_area_vector(surface.positions, surface.triangles[opposite.triangle])[2], 0);
  EXPECT_GT(opposite.distance, 0.8);
}

}  // namespace
}  // namespace flowskin::tracking::mesh_measures_test
