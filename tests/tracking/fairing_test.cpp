// Fairing with springs, relaxation and repair.
#include "tracking/fairing/fairing.h"
#include "tracking/fairing/bad_triangles.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>

#include "tests/tracking/mesh_test_shapes.h"
#include "tracking/extraction/extract_surface.h"
#include "tracking/fairing/relaxation.h"
#include "tracking/fairing/repair.h"
#include "tracking/field/metaballs/metaball_field.h"
#include "tracking/mesh/mesh_measures.h"

namespace flowskin::tracking::fairing_test {
namespace {

constexpr double kEdge = 0.8;

// A mesh of a jittered ball of particles with everything fairing needs.
struct Body {
  explicit Body(double radius)
      : field(test::ball_of_particles(radius), {}, default_field_settings(1)),
        surface(extract_surface(field, kEdge)),
        topology(build_adjacency(static_cast<int>(surface.positions.size()), surface.triangles)),
        rest_lengths(edge_lengths(topology, surface.positions)) {}
  MetaballField field;
  SurfaceGeometry surface;
  MeshAdjacency topology;
  std::vector<double> rest_lengths;
};

double largest_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double largest = 0;
  for (std::size_t v = 0; v < a.size(); ++v) largest = std::max(largest, (a[v] - b[v]).norm());
  return largest;
}

double root_mean_square(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double sum = 0;
  for (std::size_t v = 0; v < a.size(); ++v) sum += (a[v] - b[v]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(a.size()));
}

// Every vertex pushed along the surface by up to `size`, and projected.
std::vector<Vec3> perturbed(const Body& body, double size) {
  test::Random random(21);
  std::vector<Vec3> positions = body.surface.positions;
  for (Vec3& x : positions) x += size * random.vector();
  project_to_surface(body.field, default_projection(body.field.scale()), positions);
  return positions;
}

double strain(const Body& body, const std::vector<Vec3>& positions) {
  const std::vector<double> lengths = edge_lengths(body.topology, positions);
  double sum = 0;
  for (std::size_t e = 0; e < lengths.size(); ++e) sum += std::pow(lengths[e] / body.rest_lengths[e] - 1, 2);
  return std::sqrt(sum / static_cast<double>(lengths.size()));
}

TEST(Fairing, KeepsAMeshAtRest) {
  const Body body(5.3);
  std::vector<Vec3> positions = body.surface.positions;
  fair(body.field, body.topology, body.rest_lengths, {10, 0.3}, {}, positions);
  // Projection onto the tangent plane makes springs on a curved surface a little shorter than they are: no more than
  // that second-order effect may show.
  EXPECT_LT(largest_difference(positions, body.surface.positions), 0.1 * kEdge);
  EXPECT_LT(root_mean_square(positions, body.surface.positions), 0.03 * kEdge);
}

// Springs measured along the surface: what has its rest lengths stays where it is, on a curved surface too.
TEST(Fairing, VariableSpringsKeepAMeshAtRestExactly) {
  const Body body(5.3);
  std::vector<Vec3> positions = body.surface.positions;
  project_to_surface(body.field, default_projection(body.field.scale()), positions);
  const std::vector<double> rest_lengths = edge_lengths(body.topology, positions);
  const std::vector<Vec3> start = positions;
  fair(body.field, body.topology, rest_lengths, {10, 0.3}, std::vector<Confidence>(positions.size()), positions);
  EXPECT_LT(largest_difference(positions, start), 1e-6 * kEdge);
}

TEST(Fairing, VariableSpringsHoldBackWhereTheVelocityIsKnown) {
  const Body body(5.3);
  const std::vector<Vec3> start = perturbed(body, 0.15);
  std::vector<Confidence> known(start.size()), half(start.size());
  for (Confidence& confidence : known) confidence = {1, 1, Vec3::UnitX()};
  for (Confidence& confidence : half) confidence = {0.5, 0.5, Vec3::UnitX()};
  std::vector<Vec3> soft = start, medium = start, stiff = start;
  fair(body.field, body.topology, body.rest_lengths, {3, 0.3}, known, soft);
  fair(body.field, body.topology, body.rest_lengths, {3, 0.3}, half, medium);
  fair(body.field, body.topology, body.rest_lengths, {3, 0.3}, std::vector<Confidence>(start.size()), stiff);
  EXPECT_LT(largest_difference(soft, start), 1e-6 * kEdge);
  EXPECT_LT(root_mean_square(medium, start), 0.8 * root_mean_square(stiff, start));
  EXPECT_LT(strain(body, stiff), strain(body, medium));
  EXPECT_LT(strain(body, medium), strain(body, start));
}

TEST(Fairing, RepairsAPerturbedMesh) {
  const Body body(5.3);
  std::vector<Vec3> positions = perturbed(body, 0.15);
  const double before = strain(body, positions);
  const double away = root_mean_square(positions, body.surface.positions);
  fair(body.field, body.topology, body.rest_lengths, {10, 0.3}, {}, positions);
  EXPECT_LT(strain(body, positions), 0.4 * before);
  EXPECT_LT(root_mean_square(positions, body.surface.positions), 0.7 * away);
  for (const Vec3& x : positions) EXPECT_LT(surface_distance(body.field, x).distance, 0.02 * kEdge);
}

TEST(Fairing, NoIterationsAndNoStiffnessChangeNothing) {
  const Body body(3.1);
  std::vector<Vec3> positions = perturbed(body, 0.1);
  const std::vector<Vec3> before = positions;
  fair(body.field, body.topology, body.rest_lengths, {0, 0.3}, {}, positions);
  EXPECT_EQ(positions, before);
  fair(body.field, body.topology, body.rest_lengths, {10, 0}, {}, positions);
  EXPECT_LT(largest_difference(positions, before), 1e-6);
}

TEST(Fairing, NeverBlowsUp) {
  const Body body(4.2);
  for (const double factor : {0.05, 0.5, 3.0, 50.0}) {
    std::vector<double> lengths = body.rest_lengths;
    for (double& length : lengths) length *= factor;
    std::vector<Vec3> positions = perturbed(body, 0.3);
    fair(body.field, body.topology, lengths, {100, 1.0}, {}, positions);
    for (const Vec3& x : positions) {
      ASSERT_TRUE(x.allFinite());
      EXPECT_LT(surface_distance(body.field, x).distance, 0.1 * kEdge) << "rest lengths times " << factor;
    }
  }
}

// One free vertex between six neighbours of a flat regular hexagon goes to the middle.
TEST(Fairing, MoveGoesTheShareOfTheWayToEquilibrium) {
  std::vector<Vec3> positions = {{0.05, -0.03, 0}};
  std::vector<Triangle> triangles;
  for (int i = 0; i < 6; ++i) {
    const double angle = i * std::numbers::pi / 3;
    positions.emplace_back(std::cos(angle), std::sin(angle), 0.2);  // off the plane: projection must remove that
    triangles.push_back({0, 1 + i, 1 + (i + 1) % 6});
  }
  const MeshAdjacency topology = build_adjacency(7, triangles);
  const std::vector<double> rest(topology.edges.size(), 1.0);
  const Vec3 move = fairing_move({topology, rest, Laying::projected, 0.5}, 0, {0, 0, 1}, positions);
  EXPECT_LT((move - 0.5 * Vec3(-0.05, 0.03, 0)).norm(), 0.15 * 0.5 * 0.06);
  // A cap of a quarter of the shortest edge, in space.
  positions[0] = {0.6, 0, 0};
  const Vec3 far = fairing_move({topology, rest, Laying::projected, 1.0}, 0, {0, 0, 1}, positions);
  EXPECT_LE(far.norm(), 0.25 * std::hypot(0.4, 0.2) + 1e-12);
  EXPECT_LT(far[0], 0);
}

TEST(Fairing, SameBytesAtAnyThreadCount) {
  const Body body(4.2);
  const int threads = omp_get_max_threads();
  std::vector<Vec3> one = perturbed(body, 0.2), three = one;
  omp_set_num_threads(1);
  fair(body.field, body.topology, body.rest_lengths, {10, 0.3}, {}, one);
  omp_set_num_threads(3);
  fair(body.field, body.topology, body.rest_lengths, {10, 0.3}, {}, three);
  omp_set_num_threads(threads);
  EXPECT_EQ(one, three);
}

TEST(Relaxation, NeverTurnsATriangle) {
  const Body body(4.2);
  std::vector<Vec3> positions = perturbed(body, 0.25);
  const ProjectionSettings settings = default_projection(body.field.scale());
  std::vector<Vec3> normals = project_to_surface(body.field, settings, positions).normals;
  const auto inverted = [&] {
    return std::count_if(body.surface.triangles.begin(), body.surface.triangles.end(),
                         [&](const Triangle& triangle) { return is_inverted(triangle, positions, normals); });
  };
  const auto before = inverted();
  const double angle = mesh_quality(positions, body.surface.triangles).mean_smallest_angle;
  relax(body.field, settings, body.topology, body.surface.triangles, 6, {}, positions, normals);
  EXPECT_LE(inverted(), before);
  EXPECT_GT(mesh_quality(positions, body.surface.triangles).mean_smallest_angle, angle);
}

TEST(Repair, UntanglesAFoldAndLeavesTheRest) {
  const Body body(4.2);
  std::vector<Vec3> positions = body.surface.positions;
  // Vertex 0 jumps over one of its neighbours.
  const int neighbor = body.topology.ring(0)[0].vertex;
  positions[0] += 1.6 * (positions[neighbor] - positions[0]);
  const ProjectionSettings settings = default_projection(body.field.scale());
  Projection projection = project_to_surface(body.field, settings, positions);
  ASSERT_FALSE(bad_triangles(positions, body.surface.triangles, body.topology, projection.normals).empty());
  repair(body.field, settings, body.topology, body.surface.triangles, positions, projection);
  EXPECT_TRUE(bad_triangles(positions, body.surface.triangles, body.topology, projection.normals).empty());
  EXPECT_TRUE(projection.failed.empty());
  int moved = 0;
  for (std::size_t v = 0; v < positions.size(); ++v) moved += positions[v] != body.surface.positions[v] ? 1 : 0;
  EXPECT_LT(moved, 60);
}

}  // namespace
}  // namespace flowskin::tracking::fairing_test
