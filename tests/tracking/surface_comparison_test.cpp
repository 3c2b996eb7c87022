// Distances, shapes and shares of surfaces that are known in closed form.
#include "tracking/ground_truth/surface_comparison.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "common/closest_point.h"
#include "tests/tracking/mesh_test_shapes.h"
#include "tracking/mesh/hausdorff.h"
#include "tracking/mesh/mesh_measures.h"

namespace flowskin::tracking::surface_comparison_test {
namespace {

using std::numbers::pi;
using test::both;

SurfaceGeometry ball(double radius, double spacing = 0.1) {
  return test::marched([&](const Vec3& x) { return radius - x.norm(); }, radius, spacing);
}
SurfaceGeometry torus() {
  return test::marched([](const Vec3& x) { return 0.4 - std::hypot(std::hypot(x[0], x[1]) - 1, x[2]); }, 1.5, 0.1);
}
SurfaceGeometry moved(SurfaceGeometry surface, const Vec3& offset) {
  for (Vec3& x : surface.positions) x += offset;
  return surface;
}
double hausdorff(const SurfaceGeometry& a, const SurfaceGeometry& b) {
  return hausdorff_distance(a.positions, a.triangles, b.positions, b.triangles);
}

// A square of side 1 in the plane z = height, in n x n pieces.
SurfaceGeometry square(double height, int n) {
  SurfaceGeometry surface;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) surface.positions.emplace_back(double(i) / n, double(j) / n, height);
  }
  test::add_grid_triangles(0, n, surface.triangles);
  return surface;
}

TEST(Hausdorff, OfParallelSquares) {
  EXPECT_DOUBLE_EQ(hausdorff(square(0, 5), square(0.25, 7)), 0.25);
  EXPECT_DOUBLE_EQ(hausdorff(square(0.25, 7), square(0, 5)), 0.25);
  EXPECT_NEAR(hausdorff(square(0, 5), square(0, 5)), 0, 1e-15);  // the rounding of weights
  // The corner (2, 1) of the moved one is 1 from the other.
  EXPECT_DOUBLE_EQ(hausdorff(square(0, 5), moved(square(0, 3), {1, 0, 0})), 1);
}

TEST(Hausdorff, LooksFromBothSides) {
  // All of the first is on the second, which has a drop far away; and the other way round.
  const SurfaceGeometry plain = square(0, 4), with_drop = both(plain, moved(test::tetrahedron(), {0, 0, 5}));
  EXPECT_DOUBLE_EQ(hausdorff(plain, with_drop), 6);  // the tip of the tetrahedron, above the corner of the square
  EXPECT_DOUBLE_EQ(hausdorff(with_drop, plain), 6);
}

TEST(Hausdorff, SeesTheMiddleOfATriangle) {
  // A triangle, and the same with a hole: all vertices are on both, only the middle is over the hole.
  const std::vector<Vec3> corners = {{0, 0, 0}, {3, 0, 0}, {0, 3, 0}, {0.5, 0.5, 0}, {2, 0.5, 0}, {0.5, 2, 0}};
  const std::vector<Triangle> ring = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
  const double to_border = 0.5 / std::sqrt(2.0);  // from (1, 1) to x + y = 2.5
  EXPECT_DOUBLE_EQ(hausdorff_distance(corners, {{0, 1, 2}}, corners, ring), to_border);
  EXPECT_DOUBLE_EQ(hausdorff_distance(corners, ring, corners, {{0, 1, 2}}), to_border);
}

TEST(Hausdorff, OfBallsOneInTheOther) {
  const double spacing = 0.05;
  // Marching cubes puts vertices on the sphere; the middle of a triangle lies under it by e^2 / 6 at the most, for
  // equilateral triangles of edge e <= 3^0.5 spacings.
  EXPECT_NEAR(hausdorff(ball(1, spacing), ball(0.8, spacing)), 0.2, 3 * spacing * spacing / 6 / 0.8 + 1e-3);
  EXPECT_NEAR(hausdorff(ball(1, spacing), moved(ball(1, spacing), {0.3, 0, 0})), 0.3, 0.01);
}

TEST(Hausdorff, OfNothing) {
  EXPECT_EQ(hausdorff({}, {}), 0);
  EXPECT_EQ(hausdorff({}, ball(1)), std::numeric_limits<double>::infinity());
  EXPECT_EQ(hausdorff(ball(1), {}), std::numeric_limits<double>::infinity());
}

// The search that stops early, against one that does not.
TEST(Hausdorff, AgreesWithAllSamplesAndAnyNumberOfThreads) {
  const SurfaceGeometry a = torus(), b = moved(ball(1.1), {0.2, 0.1, 0});
  double expected = 0;
  const auto from = [&](const SurfaceGeometry& surface, const SurfaceGeometry& other) {
    const ClosestPointTree tree(other.positions, other.triangles);
    for (const Vec3& x : surface.positions) expected = std::max(expected, tree.closest(x, 100).distance);
    for (const auto& [i, j, k] : surface.triangles) {
      const Vec3 center = (surface.positions[i] + surface.positions[j] + surface.positions[k]) / 3;
      expected = std::max(expected, tree.closest(center, 100).distance);
    }
  };
  from(a, b);
  from(b, a);
  const int before = omp_get_max_threads();
  for (const int threads : {1, 2, 5}) {
    omp_set_num_threads(threads);
    EXPECT_EQ(hausdorff(a, b), expected) << threads << " threads";
  }
  omp_set_num_threads(before);
}

TEST(SurfaceShape, CountsPartsAndHoles) {
  const SurfaceGeometry surface = both(both(ball(1), moved(torus(), {4, 0, 0})), moved(ball(0.1, 0.05), {0, 4, 0}));
  const SurfaceShape shape = surface_shape(surface.positions, surface.triangles, 0.01);
  EXPECT_EQ(shape.components, 3);
  EXPECT_EQ(shape.small_components, 1);  // 0.0042 m^3
  EXPECT_EQ(shape.euler, 4);
  EXPECT_EQ(shape.small_euler, 2);
  EXPECT_EQ(shape.euler, euler_characteristic(surface.positions, surface.triangles));
  EXPECT_NEAR(shape.volume, 4 * pi / 3 + 2 * pi * pi * 0.16, 0.1);
  EXPECT_EQ(surface_shape(surface.positions, surface.triangles).small_components, 0);
  EXPECT_EQ(surface_shape({}, {}).components, 0);
}

TEST(SurfaceShape, ASmallCavityIsSmall) {
  const SurfaceGeometry hollow = both(ball(1), test::flipped(ball(0.1, 0.05)));
  const SurfaceShape shape = surface_shape(hollow.positions, hollow.triangles, 0.01);
  EXPECT_EQ(shape.components, 2);
  EXPECT_EQ(shape.small_components, 1);
}

SurfaceComparison compared(const SurfaceGeometry& mesh, const SurfaceGeometry& fresh, double small_volume) {
  return compare_surfaces(mesh.positions, mesh.triangles, fresh, small_volume);
}

TEST(SurfaceComparison, OfTheSameSurface) {
  const SurfaceComparison same = compared(torus(), torus(), 0);
  EXPECT_TRUE(same.same_topology());
  EXPECT_EQ(same.volume_error(), 0);
  EXPECT_NEAR(same.hausdorff, 0, 1e-15);
  const SurfaceComparison none = compared({}, {}, 0);
  EXPECT_TRUE(none.same_topology());
  EXPECT_EQ(none.volume_error(), 0);
}

TEST(SurfaceComparison, TellsADropAndAHole) {
  const SurfaceGeometry with_drop = both(ball(1), moved(ball(0.1, 0.05), {0, 3, 0}));
  EXPECT_FALSE(compared(ball(1), with_drop, 0).same_topology());
  EXPECT_TRUE(compared(ball(1), with_drop, 0.01).same_topology());  // below the resolution
  EXPECT_FALSE(compared(ball(1), torus(), 0.01).same_topology());   // one part each, but a hole
  EXPECT_EQ(compared(ball(1), torus(), 0.01).mesh.components, compared(ball(1), torus(), 0.01).fresh.components);
}

TEST(SurfaceComparison, TellsTheVolume) {
  SurfaceGeometry larger = ball(1);
  for (Vec3& x : larger.positions) x *= 1.01;
  EXPECT_NEAR(compared(larger, ball(1), 0).volume_error(), 1.01 * 1.01 * 1.01 - 1, 1e-12);
}

TEST(MeshShares, OfAnglesAndEdges) {
  // A right triangle with angles 90, 45, 45, and one with 90, 84.3, 5.7 degrees at its short side.
  const std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -0.1, 0}};
  const std::vector<Triangle> triangles = {{0, 1, 2}, {0, 3, 1}};
  const std::vector<double> angles = smallest_angles(positions, triangles);
  EXPECT_DOUBLE_EQ(share_of_angles_above(angles, 10 * pi / 180), 0.5);
  EXPECT_DOUBLE_EQ(share_of_angles_above(angles, 5 * pi / 180), 1);
  EXPECT_DOUBLE_EQ(share_of_angles_above(angles, 50 * pi / 180), 0);
  // Edges: 1, 1, sqrt 2, 0.1, sqrt 1.01.
  EXPECT_DOUBLE_EQ(share_of_edges_within(positions, triangles, 0.5, 1.2), 0.6);
  EXPECT_DOUBLE_EQ(share_of_edges_within(positions, triangles, 1, 1.5), 0.8);
  EXPECT_EQ(share_of_edges_within({}, {}, 1, 2), 1);
  EXPECT_EQ(share_of_angles_above({}, 1), 1);
}

}  // namespace
}  // namespace flowskin::tracking::surface_comparison_test
