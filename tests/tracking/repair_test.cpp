// Where mesh and field disagree, the region and only it is replaced; the topology is then that of a fresh extraction.
#include "tracking/repair/change_topology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>

#include "tests/tracking/mesh_test_shapes.h"
#include "tracking/extraction/extract_surface.h"
#include "tracking/fairing/bad_triangles.h"
#include "tracking/field/metaballs/metaball_grid.h"
#include "tracking/mesh/mesh_check.h"
#include "tracking/mesh/mesh_measures.h"
#include "tracking/repair/disagreement.h"
#include "tracking/repair/grid_crossings.h"
#include "tracking/repair/patch_mesh.h"
#include "tracking/repair/repair_limits.h"
#include "tracking/repair/replace_region.h"

namespace flowskin::tracking::repair_test {
namespace {

using test::ball_of_particles;
using test::joined;
using test::particles_at;

constexpr double kEdge = 0.75;
const FieldSettings kField = default_field_settings(1);

SparseGrid grid_of(const MetaballField& field) {
  return grid_of_particles(field.positions(), field.settings(), kEdge, {});
}

// ---------------------------------------------------------------- crossings

// Winding numbers at the nodes of the lines along one axis, from the crossings.
int winding_at(const std::vector<GridCrossing>& crossings, int axis, const SparseGrid::Index& node) {
  int winding = 0;
  for (const GridCrossing& crossing : crossings) {
    if (crossing.line == std::array<int, 2>{node[(axis + 1) % 3], node[(axis + 2) % 3]} && crossing.place < node[axis])
      winding += crossing.change;
  }
  return winding;
}

TEST(GridCrossings, WindingIsTheSignOfTheFieldThatWasMarched) {
  const MetaballField field(ball_of_particles(2.6), {}, kField);
  const SparseGrid grid = grid_of(field);
  const SurfaceGeometry surface = march(grid);
  for (int axis = 0; axis < 3; ++axis) {
    const auto crossings = grid_crossings(grid, axis, surface.positions, surface.triangles);
    int inside = 0;
    for (int i = -7; i <= 7; ++i) {
      for (int j = -7; j <= 7; ++j) {
        for (int k = -7; k <= 7; ++k) {
          const bool is_inside = grid.value({i, j, k}) > 0;
          inside += is_inside;
          EXPECT_EQ(winding_at(crossings, axis, {i, j, k}), is_inside ? 1 : 0) << i << " " << j << " " << k;
        }
      }
    }
    EXPECT_GT(inside, 100);
  }
}

TEST(GridCrossings, EveryLineLeavesAsOftenAsItEnters_EvenThroughVerticesAndEdges) {
  // A cube whose corners, edges and diagonals all lie on grid lines.
  const SparseGrid grid = SparseGrid::of_values({1, 1, 1}, {-1}, -1, 1);
  std::vector<Vec3> positions;
  for (int c = 0; c < 8; ++c) positions.push_back(grid.position({4 * (c & 1), 4 * (c >> 1 & 1), 4 * (c >> 2 & 1)}));
  const std::vector<Triangle> triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                           {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  ASSERT_EQ(joined(mesh_problems(positions, triangles)), "");
  for (int axis = 0; axis < 3; ++axis) {
    const auto crossings = grid_crossings(grid, axis, positions, triangles);
    int lines = 0;
    for_each_line(crossings, [&](const GridCrossing* begin, const GridCrossing* end) {
      ++lines;
      ASSERT_EQ(end - begin, 2);
      EXPECT_EQ(begin[0].change, 1);
      EXPECT_EQ(begin[1].change, -1);
      EXPECT_NEAR(begin[1].place - begin[0].place, 4, 1e-9);
    });
    EXPECT_EQ(lines, 16);  // of 25, the shifted ones that pass through
  }
}

// ---------------------------------------------------------------- disagreement

std::vector<CellSet::Cell> disagreements(const MetaballField& field, const SurfaceGeometry& mesh) {
  const SparseGrid grid = grid_of(field);
  return disagreeing_cells(field, grid, 0.3 * kEdge, grid_crossings(grid, mesh.positions, mesh.triangles));
}

std::vector<CellSet::Cell> displacements(const MetaballField& field, const SurfaceGeometry& mesh) {
  const SparseGrid grid = grid_of(field);
  return displaced_cells(field, grid, 0.45, grid_crossings(grid, mesh.positions, mesh.triangles));
}

TEST(Disagreement, NoneForAFreshMesh) {
  for (const double radius : {2.3, 4.2, 6.3}) {
    const MetaballField field(ball_of_particles(radius), {}, kField);
    const SurfaceGeometry mesh = extract_surface(field, kEdge);
    EXPECT_TRUE(disagreements(field, mesh).empty());
    EXPECT_TRUE(displacements(field, mesh).empty());
  }
}

// One half of a ball's mesh is 0.7 cells too small: on some grid edges mesh and field cross too far from each other.
TEST(Disagreement, DisplacedSurfaceIsSeenWhereItIs) {
  const MetaballField field(ball_of_particles(4.2), {}, kField);
  SurfaceGeometry mesh = extract_surface(field, kEdge);
  for (Vec3& x : mesh.positions) {
    if (x.x() > 0) x *= 1 - 0.7 * kEdge / x.norm();
  }
  const auto cells = displacements(field, mesh);
  EXPECT_GT(cells.size(), 20U);
  const SparseGrid grid = grid_of(field);
  for (const auto& cell : cells) EXPECT_GT(grid.position(cell).x(), -2 * kEdge);
}

// Particles in a film that is about to tear, so far apart that the field is hardly above or below zero between them.
std::vector<Vec3> thin_film(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> shift(-0.4, 0.4);
  std::vector<Vec3> points;
  for (int i = -12; i <= 12; ++i) {
    for (int j = -12; j <= 12; ++j) {
      const double x = i + shift(random), y = j + shift(random);
      points.emplace_back(x, y, shift(random));
    }
  }
  return points;
}

// Vertices of the mesh are where straight lines between the values of the nodes are zero. The field's roots show which
// of them are wrong. Nearly all of those are seen, none by the straight lines themselves.
TEST(Disagreement, DisplacementIsSeenWhereTheValuesOfTheGridHideIt) {
  constexpr double kCell = 1, kApart = 0.35, kFar = 0.45;
  int displaced = 0, unseen = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const MetaballField field(thin_film(seed), {}, kField);
    const SparseGrid grid = grid_of_particles(field.positions(), field.settings(), kCell, {});
    const SurfaceGeometry mesh = march(grid);
    const auto crossings = grid_crossings(grid, mesh.positions, mesh.triangles);
    const CellSet seen(displaced_cells(field, grid, kApart, crossings));
    const auto value = [&](const Vec3& x) { return field.value(x); };
    for (const Vec3& x : mesh.positions) {
      Vec3 root = x;
      put_on_root(grid, value, root);
      if ((root - x).norm() < kFar * kCell) continue;
      ++displaced;
      unseen += meets(seen, grid.coordinates(x), grid.coordinates(x)) ? 0 : 1;
    }
  }
  EXPECT_GT(displaced, 100);
  EXPECT_LE(unseen, displaced / 100);  // a parabola is not the field
}

std::vector<Vec3> two_balls(double distance) {
  std::vector<Vec3> points = ball_of_particles(3.2, {-distance / 2, 0, 0});
  for (const Vec3& x : ball_of_particles(3.2, {distance / 2, 0, 0}, 5)) points.push_back(x);
  return points;
}

TEST(Disagreement, IsSeenWhereBallsHaveMergedAndNowhereElse) {
  const MetaballField apart(two_balls(9), {}, kField);
  SurfaceGeometry mesh = extract_surface(apart, kEdge);
  for (Vec3& x : mesh.positions) x[0] += x[0] < 0 ? 0.9 : -0.9;
  const MetaballField merged(two_balls(7.2), {}, kField);
  const SparseGrid grid = grid_of(merged);
  const auto cells = disagreements(merged, mesh);
  ASSERT_FALSE(cells.empty());
  for (const auto& cell : cells) EXPECT_LT(std::abs(grid.position(cell)[0]), 2) << "far from the neck";
}

TEST(Disagreement, IsSeenBetweenSheetsCloserThanACell) {
  // A slit of a tenth of a cell through the middle of a ball of fluid.
  const MetaballField field(ball_of_particles(4.2), {}, kField);
  const SparseGrid grid = grid_of(field);
  SurfaceGeometry mesh = extract_surface(field, kEdge);
  SurfaceGeometry slit = test::marched(
      [](const Vec3& x) { return 0.04 - std::hypot(std::max(0.0, std::hypot(x.y(), x.z()) - 1.5), x.x()); }, 2, 0.03);
  for (Vec3& x : slit.positions) x += Vec3(grid.position({0, 0, 0})[0] + 0.5 * kEdge, 0, 0);
  mesh = test::both(mesh, test::flipped(slit));
  const auto cells = disagreements(field, mesh);
  EXPECT_GT(cells.size(), 8u);
}

// ---------------------------------------------------------------- patch mesh

// A square of n x n cells of side 1 in the plane z = 0, seen from above.
SurfaceGeometry square(int n) {
  SurfaceGeometry surface;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) surface.positions.emplace_back(i, j, 0);
  }
  const auto at = [n](int i, int j) { return i * (n + 1) + j; };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      surface.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      surface.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return surface;
}

TEST(PatchMesh, TakesInAnyPolygon) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> noise(-0.3, 0.3);
  for (int trial = 0; trial < 200; ++trial) {
    const SurfaceGeometry start = square(10);
    PatchMesh patch(start.positions, start.triangles);
    const int corners = 5 + trial % 20;
    std::vector<int> loop;
    std::vector<Vec3> places;
    for (int c = 0; c < corners; ++c) {
      const double angle = 2 * M_PI * c / corners, radius = 3 + noise(random);
      places.push_back(Vec3(5 + noise(random) * 0.3 + radius * std::cos(angle), 5 + radius * std::sin(angle), 0));
      loop.push_back(patch.insert(places.back(), Vec3::UnitZ(), 1));
      ASSERT_GE(loop.back(), 0);
      EXPECT_EQ(patch.positions()[loop.back()], places.back());
    }
    for (int c = 0; c < corners; ++c) {
      ASSERT_TRUE(patch.connect(loop[c], loop[(c + 1) % corners], Vec3::UnitZ())) << trial;
    }
    double area = 0;
    for (const Triangle& triangle : patch.triangles()) {
      const double part = doubled_area_vector(patch.positions(), triangle)[2] / 2;
      EXPECT_GT(part, 0) << "turned over";
      area += part;
    }
    EXPECT_NEAR(area, 100, 1e-9);
    EXPECT_EQ(euler_characteristic(patch.positions(), patch.triangles()), 1);
    for (int c = 0; c < corners; ++c) EXPECT_EQ(patch.positions()[loop[c]], places[c]);
  }
}

TEST(PatchMesh, RefusesWhatIsTooFarOrOutside) {
  const SurfaceGeometry start = square(3);
  PatchMesh patch(start.positions, start.triangles);
  EXPECT_LT(patch.insert({1.2, 1.3, 2}, Vec3::UnitZ(), 1), 0);
  EXPECT_LT(patch.insert({1.2, 1.3, 0}, -Vec3::UnitZ(), 1), 0);
  EXPECT_LT(patch.insert({-0.5, 1.3, 0}, Vec3::UnitZ(), 1), 0);
}

// ---------------------------------------------------------------- change of topology

struct Surface {
  SurfaceMesh mesh;
  Projection projection;
};

Surface fresh_surface(const MetaballField& field, const Particles& particles) {
  SurfaceGeometry geometry = extract_surface(field, kEdge);
  const Projection projection = project_to_surface(field, default_projection(kField.scale()), geometry.positions);
  return {carry_material({}, geometry, projection.normals, field, particles, {}), projection};
}

TopologySettings settings() {
  TopologySettings settings;
  settings.edge_length = kEdge;
  settings.depth = 0.3 * kEdge;
  settings.material.reach = kEdge;
  settings.material.far_reach = 2 * kField.radius;
  return settings;
}

// Puts the old mesh into a field with other particles and lets the topology follow.
struct Change {
  Surface before;
  SurfaceMesh after;
  TopologyReport report;
  double kept_share = 0;
};

Change changed(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  Change change;
  const Particles old_particles = particles_at(from), particles = particles_at(to);
  const MetaballField old_field(from, {}, kField), field(to, {}, kField);
  change.before = fresh_surface(old_field, old_particles);
  change.after = change.before.mesh;
  Projection projection = project_to_surface(field, default_projection(kField.scale()), change.after.positions);
  change.before.mesh.positions = change.after.positions;
  change.report = change_topology(field, particles, settings(), change.after, projection);

  EXPECT_EQ(joined(mesh_problems(change.after)), "");
  EXPECT_EQ(change.report.stubborn, 0) << change.report.why;
  const SurfaceGeometry fresh = extract_raw_surface(field, kEdge);
  EXPECT_EQ(mesh_components(change.after.positions, change.after.triangles).count,
            mesh_components(fresh.positions, fresh.triangles).count);
  EXPECT_EQ(euler_characteristic(change.after.positions, change.after.triangles),
            euler_characteristic(fresh.positions, fresh.triangles));
  const double volume = mesh_volume(fresh.positions, fresh.triangles);
  EXPECT_NEAR(mesh_volume(change.after.positions, change.after.triangles), volume, 0.01 * volume);
  const MeshAdjacency topology =
      build_adjacency(static_cast<int>(change.after.positions.size()), change.after.triangles);
  EXPECT_TRUE(bad_triangles(change.after.positions, change.after.triangles, topology, projection.normals).empty());
  EXPECT_TRUE(projection.failed.empty());

  // Who keeps its id keeps all it has.
  std::map<std::uint64_t, std::size_t> old;
  for (std::size_t v = 0; v < change.before.mesh.ids.size(); ++v) old[change.before.mesh.ids[v]] = v;
  int kept = 0;
  for (std::size_t v = 0; v < change.after.ids.size(); ++v) {
    const auto found = old.find(change.after.ids[v]);
    if (found == old.end()) continue;
    ++kept;
    EXPECT_LT((change.after.positions[v] - change.before.mesh.positions[found->second]).norm(), 1e-6);
    EXPECT_EQ(change.after.rest_positions[v], change.before.mesh.rest_positions[found->second]);
  }
  change.kept_share = kept / static_cast<double>(change.before.mesh.ids.size());
  return change;
}

TEST(ChangeTopology, LeavesAMeshThatFitsUntouched) {
  const std::vector<Vec3> points = ball_of_particles(4.2);
  const Change change = changed(points, points);
  EXPECT_FALSE(change.report.changed());
  EXPECT_EQ(change.after.triangles, change.before.mesh.triangles);
}

TEST(ChangeTopology, BallsMerge) {
  for (const double distance : {7.4, 7.2, 7.0, 6.8}) {
    SCOPED_TRACE(distance);
    const Change change = changed(two_balls(7.7), two_balls(distance));
    EXPECT_GT(change.report.regions, 0);
    EXPECT_GT(change.kept_share, 0.6);
  }
}

TEST(ChangeTopology, BallsPart) {
  for (const double distance : {7.8, 8.0, 8.4}) {
    SCOPED_TRACE(distance);
    const Change change = changed(two_balls(7.0), two_balls(distance));
    EXPECT_GT(change.report.regions, 0);
    EXPECT_GT(change.kept_share, 0.6);
  }
}

std::vector<Vec3> with_hole(double radius) {
  std::vector<Vec3> points;
  for (const Vec3& x : ball_of_particles(5.5)) {
    if (std::abs(x.z()) < 2.4 && std::hypot(x.x(), x.y()) >= radius) points.push_back(x);
  }
  return points;
}

TEST(ChangeTopology, AHoleOpensAndCloses) {
  EXPECT_GT(changed(with_hole(0), with_hole(2.6)).kept_share, 0.3);
  EXPECT_GT(changed(with_hole(2.6), with_hole(0)).kept_share, 0.3);
}

std::vector<Vec3> with_cavity(double radius) {
  std::vector<Vec3> points;
  for (const Vec3& x : ball_of_particles(6.3)) {
    if (x.norm() >= radius) points.push_back(x);
  }
  return points;
}

TEST(ChangeTopology, ACavityOpensAndCloses) {
  EXPECT_EQ(changed(with_cavity(0), with_cavity(3.2)).kept_share, 1);
  changed(with_cavity(3.2), with_cavity(0));
}

TEST(ChangeTopology, PartsComeAndGo) {
  const Change born = changed(ball_of_particles(3.2, {-6, 0, 0}), two_balls(12));
  EXPECT_EQ(born.kept_share, 1);
  changed(two_balls(12), ball_of_particles(3.2, {-6, 0, 0}));
}

// A fresh mesh of a ball is spoilt; it must come out sound, and most of it as it was.
void expect_mended(const std::function<void(SurfaceMesh&)>& spoil, double least_kept) {
  const std::vector<Vec3> points = ball_of_particles(4.2);
  const Particles particles = particles_at(points);
  const MetaballField field(points, {}, kField);
  SurfaceMesh mesh = fresh_surface(field, particles).mesh;
  const std::vector<std::uint64_t> old_ids = mesh.ids;
  spoil(mesh);
  Projection projection = project_to_surface(field, default_projection(kField.scale()), mesh.positions);
  const TopologyReport report = change_topology(field, particles, settings(), mesh, projection);
  EXPECT_GT(report.regions, 0);
  EXPECT_EQ(report.stubborn, 0) << report.why;
  EXPECT_EQ(joined(mesh_problems(mesh)), "");
  EXPECT_TRUE(projection.failed.empty());
  const MeshAdjacency topology = build_adjacency(static_cast<int>(mesh.positions.size()), mesh.triangles);
  EXPECT_TRUE(bad_triangles(mesh.positions, mesh.triangles, topology, projection.normals).empty());
  const SurfaceGeometry fresh = extract_raw_surface(field, kEdge);
  const double volume = mesh_volume(fresh.positions, fresh.triangles);
  EXPECT_NEAR(mesh_volume(mesh.positions, mesh.triangles), volume, 0.01 * volume);
  std::size_t kept = 0;
  for (std::uint64_t id : old_ids) kept += std::count(mesh.ids.begin(), mesh.ids.end(), id);
  EXPECT_GE(static_cast<double>(kept), least_kept * static_cast<double>(old_ids.size()));
}

TEST(ChangeTopology, MendsAFold) {
  expect_mended(
      [](SurfaceMesh& mesh) {
        const int neighbor = mesh.triangles[0][1];
        mesh.positions[mesh.triangles[0][0]] += 1.7 * (mesh.positions[neighbor] - mesh.positions[mesh.triangles[0][0]]);
      },
      0.85);
}

TEST(ChangeTopology, MendsATriangleWithoutArea) {
  expect_mended(
      [](SurfaceMesh& mesh) { mesh.positions[mesh.triangles[17][0]] = mesh.positions[mesh.triangles[17][1]]; }, 0.85);
}

TEST(ChangeTopology, MendsAVertexThatWasLost) {
  expect_mended([](SurfaceMesh& mesh) { mesh.positions[3] *= 4; }, 0.7);
}

// The regions that are replaced where the triangles in one place of a ball are squeezed to a seventh of their width,
// with another ball far away.
int regions_of_squeezed(double radius_elsewhere) {
  std::vector<Vec3> points = ball_of_particles(4.2);
  for (const Vec3& x : ball_of_particles(radius_elsewhere, Vec3(60, 0, 0))) points.push_back(x);
  const Particles particles = particles_at(points);
  const MetaballField field(points, {}, kField);
  SurfaceMesh mesh = fresh_surface(field, particles).mesh;
  const Vec3 middle(0, 0, 4.7);
  for (Vec3& x : mesh.positions) {
    if ((x - middle).norm() < 1.5 * kEdge) x.x() /= 7;
  }
  Projection projection = project_to_surface(field, default_projection(kField.scale()), mesh.positions);
  const std::vector<double> angles = smallest_angles(mesh.positions, mesh.triangles);
  const auto narrow =
      std::count_if(angles.begin(), angles.end(), [](double a) { return a < kRepairLimits.narrow_angle; });
  EXPECT_GE(narrow, 3);
  EXPECT_LE(narrow, 16);
  const TopologyReport report = change_topology(field, particles, settings(), mesh, projection);
  EXPECT_EQ(report.stubborn, 0);
  return report.regions;
}

TEST(ChangeTopology, MendsNarrowTrianglesWhateverIsElsewhere) {
  const int alone = regions_of_squeezed(3);
  EXPECT_GT(alone, 0);
  EXPECT_EQ(regions_of_squeezed(20), alone);
}

TEST(ChangeTopology, ReplacesAMeshThatIsInsideOutOrMissing) {
  expect_mended(
      [](SurfaceMesh& mesh) {
        for (auto& [a, b, c] : mesh.triangles) std::swap(b, c);
      },
      0);
  expect_mended([](SurfaceMesh& mesh) { mesh = {}; }, 0);
}

TEST(BadTriangles, AreSeen) {
  const MetaballField field(ball_of_particles(4.2), {}, kField);
  const SurfaceMesh sound = fresh_surface(field, particles_at(ball_of_particles(4.2))).mesh;
  const auto count_bad = [&](const SurfaceMesh& mesh) {
    std::vector<Vec3> positions = mesh.positions;
    const Projection projection = project_to_surface(field, default_projection(kField.scale()), positions);
    return bad_triangles(mesh.positions, mesh.triangles,
                         build_adjacency(static_cast<int>(positions.size()), mesh.triangles), projection.normals)
        .size();
  };
  EXPECT_EQ(count_bad(sound), 0u);
  SurfaceMesh mesh = sound;
  mesh.positions[mesh.triangles[17][0]] = mesh.positions[mesh.triangles[17][1]];
  EXPECT_GE(count_bad(mesh), 1u);
  mesh = sound;
  for (auto& [a, b, c] : mesh.triangles) std::swap(b, c);
  EXPECT_EQ(count_bad(mesh), mesh.triangles.size());
  mesh = sound;
  const int neighbor = mesh.triangles[0][1];
  mesh.positions[mesh.triangles[0][0]] += 1.7 * (mesh.positions[neighbor] - mesh.positions[mesh.triangles[0][0]]);
  EXPECT_GE(count_bad(mesh), 1u);
}

}  // namespace
}  // namespace flowskin::tracking::repair_test
