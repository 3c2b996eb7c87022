// Where two surfaces are too far from each other.
#include "tracking/repair/strays.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <random>

#include "tests/tracking/mesh_test_shapes.h"
#include "tracking/extraction/extract_surface.h"
#include "tracking/field/metaballs/metaball_grid.h"
#include "tracking/mesh/mesh_measures.h"
#include "tracking/repair/change_topology.h"

namespace flowskin::tracking::strays_test {
namespace {

using test::ball_of_particles;

constexpr double kEdge = 1;
const FieldSettings kField = default_field_settings(1);

SparseGrid grid_of(const MetaballField& field) { return grid_of_particles(field.positions(), field.settings(), kEdge); }

ScalarFunction value_of(const MetaballField& field) {
  return [&field](const Vec3& x) { return field.value(x); };
}

bool has_cell_at(const std::vector<CellSet::Cell>& cells, const SparseGrid& grid, const Vec3& x) {
  return CellSet(cells).contains(cell_at(grid.coordinates(x)));
}

// All cells with a triangle of a surface, and those around them.
CellSet cells_of(const SparseGrid& grid, const SurfaceGeometry& surface) {
  std::vector<CellSet::Cell> cells;
  for (const Vec3& x : surface.positions) add_cells(grid.coordinates(x), grid.coordinates(x), cells);
  return CellSet(std::move(cells)).dilated(1);
}

TEST(ClosestPointTree, IsNearWhereClosestFindsSomething) {
  const MetaballField field(ball_of_particles(3.2), {}, kField);
  const SurfaceGeometry surface = extract_surface(field, kEdge);
  const ClosestPointTree tree(surface.positions, surface.triangles);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> anywhere(-5, 5), reaches(0, 3);
  int near = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 x(anywhere(random), anywhere(random), anywhere(random));
    const Vec3 normal = i % 2 ? Vec3::Zero() : Vec3(anywhere(random), anywhere(random), anywhere(random));
    const double reach = reaches(random);
    const bool found = tree.closest(x, reach, normal, 0.5).triangle >= 0;
    EXPECT_EQ(tree.is_near(x, reach, normal, 0.5), found);
    near += found;
  }
  EXPECT_GT(near, 300);
  EXPECT_LT(near, 1700);
}

TEST(SparseGrid, CornerValuesAreThoseOfTheNodes) {
  const MetaballField field(ball_of_particles(4.2), {}, kField);
  const SparseGrid grid = grid_of(field);
  // Within blocks, across their borders, and where there are none.
  for (int i = -12; i < 12; i += 1) {
    for (const int j : {-9, -1, 0, 3, 7}) {
      for (const int k : {-8, -2, 6, 7, 15}) {
        const auto values = grid.corner_values({i, j, k});
        for (int c = 0; c < 8; ++c)
          EXPECT_EQ(values[c], grid.value({i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)})) << i << " " << j << " " << k;
      }
    }
  }
}

TEST(MarchingCubes, VerticesArePutOnRootsAsIfMarchedWithTheField) {
  const MetaballField field(ball_of_particles(3.2), {}, kField);
  const SparseGrid grid = grid_of(field);
  SurfaceGeometry linear = march(grid);
  const SurfaceGeometry rooted = march(grid, value_of(field));
  ASSERT_EQ(linear.positions.size(), rooted.positions.size());
  double moved = 0;
  for (std::size_t v = 0; v < linear.positions.size(); ++v) {
    const Vec3 before = linear.positions[v];
    put_on_root(grid, value_of(field), linear.positions[v]);
    moved = std::max(moved, (linear.positions[v] - before).norm());
    EXPECT_EQ(linear.positions[v], rooted.positions[v]);
  }
  EXPECT_GT(moved, 1e-3);
}

TEST(MarchingCubes, InSomeCellsIsTheSameForAnyNumberOfThreads) {
  const MetaballField field(ball_of_particles(4.2), {}, kField);
  const SparseGrid grid = grid_of(field);
  const CellSet cells = cells_of(grid, march(grid));
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const SurfaceGeometry one = march(grid, cells, value_of(field));
  omp_set_num_threads(3);
  const SurfaceGeometry three = march(grid, cells, value_of(field));
  omp_set_num_threads(threads);
  EXPECT_EQ(one.positions, three.positions);
  EXPECT_EQ(one.triangles, three.triangles);
  EXPECT_EQ(one.triangles.size(), march(grid).triangles.size());
}

// A triangle across a ridge: its corners are near, its centre is not.
TEST(FarCenters, AreSeenWhereTheCornersAreNear) {
  const SparseGrid grid = SparseGrid::of_values({1, 1, 1}, {-1}, -1, 1);
  const auto at = [&](double x, double y, double z) { return Vec3(grid.position({0, 0, 0}) + Vec3(x, y, z)); };
  const SurfaceGeometry ridge{
      {at(0, 0, 0.1), at(2, 0, 0.1), at(0, 1, 1.1), at(2, 1, 1.1), at(0, 2, 0.1), at(2, 2, 0.1)},
      {{0, 1, 3}, {0, 3, 2}, {2, 3, 5}, {2, 5, 4}}};
  const SurfaceGeometry cut{{at(0, 0, 0.1), at(2, 0, 0.1), at(1, 2, 0.1)}, {{0, 1, 2}}};
  const ClosestPointTree tree(ridge.positions, ridge.triangles);
  // The centre is 2 / 3 from the ridge's foot, and its sides rise by 45 degrees.
  EXPECT_TRUE(far_centers(grid, 0.48, cut, tree).empty());
  const auto cells = far_centers(grid, 0.46, cut, tree);
  EXPECT_EQ(cells.size(), 1U);
  EXPECT_TRUE(has_cell_at(cells, grid, at(1, 2.0 / 3, 0.1)));
}

TEST(FarFromGridSurface, NoneOfThatSurfaceAndWhatWasMovedAway) {
  const MetaballField field(ball_of_particles(4.2), {}, kField);
  const SparseGrid grid = grid_of(field);
  const SurfaceGeometry linear = march(grid);
  const ClosestPointTree tree(linear.positions, linear.triangles);
  EXPECT_TRUE(far_from_grid_surface(grid, 0.01, linear.positions, linear.triangles, tree).empty());
  SurfaceGeometry mesh = linear;
  for (const std::size_t v : {std::size_t{7}, mesh.positions.size() / 2}) {
    mesh.positions[v] *= 1 + 0.5 / mesh.positions[v].norm();
    const auto cells = far_from_grid_surface(grid, 0.3, mesh.positions, mesh.triangles, tree);
    EXPECT_TRUE(has_cell_at(cells, grid, mesh.positions[v]));
    for (const auto& cell : cells) EXPECT_LT((grid.position(cell) - mesh.positions[v]).norm(), 3);
    mesh = linear;
  }
}

TEST(StrayCells, NoneBetweenAFreshMeshAndItsField) {
  const MetaballField field(ball_of_particles(4.2), {}, kField);
  const SparseGrid grid = grid_of(field);
  const SurfaceGeometry mesh = march(grid, value_of(field));
  EXPECT_TRUE(stray_cells(grid, 0.01, mesh.positions, mesh.triangles, cells_of(grid, mesh), value_of(field)).empty());
}

// The mesh has a part that the field has not, and lacks one that it has.
TEST(StrayCells, AreThoseOfPartsThatOneSurfaceLacks) {
  std::vector<Vec3> points = ball_of_particles(3.2), more = points, others = points;
  for (const Vec3& x : ball_of_particles(2.3, {12, 0, 0}, 5)) more.push_back(x);
  for (const Vec3& x : ball_of_particles(2.3, {0, 12, 0}, 5)) others.push_back(x);
  const MetaballField field(more, {}, kField), other(others, {}, kField);
  const SparseGrid grid = grid_of(field);
  const SurfaceGeometry mesh = march(grid_of(other), value_of(other));
  const CellSet everywhere = cells_of(grid, mesh).united(cells_of(grid, march(grid)));
  const auto cells = stray_cells(grid, 0.4 * kEdge, mesh.positions, mesh.triangles, everywhere, value_of(field));
  int beside = 0, above = 0;
  for (const auto& cell : cells) {
    const Vec3 x = grid.position(cell);
    beside += x.x() > 6;
    above += x.y() > 6;
    EXPECT_TRUE(x.x() > 6 || x.y() > 6) << x.transpose();
  }
  EXPECT_GT(beside, 10);
  EXPECT_GT(above, 10);
}

TEST(SurfaceCounts, AgreeWhereOnlyPartsBelowACellDiffer) {
  const SurfaceCounts a{{2, 4}, {1, 2}}, a_little_larger{{2, 4}, {2, 4}}, more{{3, 6}, {2, 4}}, hole{{2, 2}, {1, 0}};
  EXPECT_TRUE(a.agree_with(a));
  EXPECT_TRUE(a.agree_with(a_little_larger));  // a part that is about a cell
  EXPECT_TRUE(a_little_larger.agree_with(more));
  EXPECT_FALSE(a.agree_with(more));
  EXPECT_FALSE(a.agree_with(hole));
}

}  // namespace
}  // namespace flowskin::tracking::strays_test
