// Marching cubes: sound on any values, right on shapes that are known; and the improved mesh.
#include "tracking/extraction/extract_surface.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <array>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <stdexcept>

#include "tests/tracking/mesh_test_shapes.h"
#include "tracking/advection/projection.h"
#include "tracking/extraction/cell_triangles.h"
#include "tracking/extraction/marching_cubes_tables.h"
#include "tracking/field/metaballs/metaball_grid.h"
#include "tracking/mesh/mesh_check.h"
#include "tracking/mesh/mesh_measures.h"
#include "tracking/mesh/self_intersections.h"

namespace flowskin::tracking::extraction_test {
namespace {

using std::numbers::pi;
using test::ball_of_particles;
using test::joined;
using test::marched;

std::string problems_of(const SurfaceGeometry& surface) {
  return joined(mesh_problems(surface.positions, surface.triangles));
}

TEST(CellTables, UseEachCrossedEdgeAndNoOther) {
  const CellTables& tables = cell_tables();
  for (int pattern = 0; pattern < 256; ++pattern) {
    for (const auto& triangles : tables.triangulations[pattern]) {
      std::set<int> used;
      for (const auto& triangle : triangles) used.insert(triangle.begin(), triangle.end());
      for (int edge = 0; edge < 12; ++edge) {
        const auto& [a, b] = tables.edge_corners[edge];
        const bool crossed = (pattern >> a & 1) != (pattern >> b & 1);
        EXPECT_EQ(used.count(edge) == 1, crossed) << "pattern " << pattern << ", edge " << edge;
      }
    }
  }
}

void expect_no_diagonal_in_a_face(const CellTables::Triangles& triangles) {
  const CellTables& tables = cell_tables();
  std::map<std::pair<int, int>, int> uses;  // of undirected sides
  for (const auto& triangle : triangles) {
    for (int corner = 0; corner < 3; ++corner) ++uses[std::minmax(triangle[corner], triangle[(corner + 1) % 3])];
  }
  for (const auto& [side, count] : uses) {
    if (count == 1) continue;  // a segment on a face
    EXPECT_EQ(count, 2);
    const auto& a = tables.edge_corners[side.first];
    const auto& b = tables.edge_corners[side.second];
    for (int axis = 0; axis < 3; ++axis) {
      const int bits = (a[0] >> axis & 1) + (a[1] >> axis & 1) + (b[0] >> axis & 1) + (b[1] >> axis & 1);
      EXPECT_TRUE(bits != 0 && bits != 4);
    }
  }
}

TEST(CellTables, NoDiagonalLiesInAFace) {
  for (const auto& all : cell_tables().triangulations) {
    ASSERT_FALSE(all.empty());
    for (const auto& triangles : all) expect_no_diagonal_in_a_face(triangles);
  }
}

TEST(CellTriangles, DoNotIntersectWhereverTheVerticesLie) {
  const CellTables& tables = cell_tables();
  std::mt19937 random(11);
  std::uniform_real_distribution<double> anywhere(0.001, 0.999);
  int first_intersects = 0, all_intersect = 0;
  const auto intersections = [](const CellTables::Triangles& triangles, const std::array<Vec3, 12>& places) {
    return self_intersections({places.begin(), places.end()}, {triangles.begin(), triangles.end()}).size();
  };
  for (int round = 0; round < 40; ++round) {
    for (int pattern = 0; pattern < 256; ++pattern) {
      std::array<Vec3, 12> places;
      for (int edge = 0; edge < 12; ++edge) {
        const int low = tables.edge_corners[edge][0];
        // Near the ends folds are most likely.
        const double t = round % 2 == 0 ? anywhere(random) : std::pow(anywhere(random), 4);
        places[edge] =
            Vec3(low & 1, low >> 1 & 1, low >> 2 & 1) + (random() % 2 == 0 ? t : 1 - t) * Vec3::Unit(edge / 4);
      }
      first_intersects += intersections(tables.triangulations[pattern].front(), places) > 0;
      all_intersect += intersections(triangles_of_cell(pattern, places), places) > 0;
    }
  }
  EXPECT_GT(first_intersects, 0);
  EXPECT_EQ(all_intersect, 0);
}

// Two cells that share a face, all 4096 sign patterns for each axis: 16 x 16 x 16 pairs, apart from each other.
TEST(MarchingCubes, SoundOnAllPairsOfCells) {
  for (int axis = 0; axis < 3; ++axis) {
    constexpr int tile = 4, count = 16 * tile;
    std::vector<double> values(count * count * count, -1.0);
    for (int pattern = 0; pattern < 4096; ++pattern) {
      for (int node = 0; node < 12; ++node) {
        SparseGrid::Index index{tile * (pattern & 15), tile * (pattern >> 4 & 15), tile * (pattern >> 8)};
        index[axis] += node % 3;
        index[(axis + 1) % 3] += node / 3 % 2;
        index[(axis + 2) % 3] += node / 6;
        if ((pattern >> node & 1) != 0) values[(index[0] * count + index[1]) * count + index[2]] = 1;
      }
    }
    const SurfaceGeometry surface = march(SparseGrid::of_values({count, count, count}, values, -1, 1));
    EXPECT_EQ(problems_of(surface), "") << "axis " << axis;
    // Each node inside encloses 1/6 at least where it stands alone: nothing has been lost.
    EXPECT_GT(mesh_volume(surface.positions, surface.triangles), 4096.0);
  }
}

TEST(MarchingCubes, SoundOnRandomSignsWithExactZeros) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    test::Random random(seed);
    const SparseGrid::Index size{11, 18, 9};
    std::vector<double> values(11 * 18 * 9);
    for (double& value : values) {
      value = random.symmetric();
      if (seed % 3 == 0) value = value > 0.3 ? 1 : value > -0.3 ? 0 : -1;
      if (seed % 3 == 1) value = std::abs(value) < 0.2 ? 0 : value + 0.4;
    }
    const SurfaceGeometry surface = march(SparseGrid::of_values(size, values, -1, 0.01));
    EXPECT_GT(surface.triangles.size(), 1000U);
    EXPECT_EQ(problems_of(surface), "") << "seed " << seed;
  }
}

TEST(MarchingCubes, BallConvergesWithTheSquareOfTheSpacing) {
  const auto ball = [](const Vec3& x) { return 1 - x.squaredNorm(); };
  std::array<double, 3> volume_error{}, area_error{};
  for (int level = 0; level < 3; ++level) {
    const SurfaceGeometry surface = marched(ball, 1, 0.2 / (1 << level));
    for (const Vec3& x : surface.positions) EXPECT_NEAR(x.norm(), 1, 1e-3 * 0.2 / (1 << level) + 1e-9);
    volume_error[level] = 1 - mesh_volume(surface.positions, surface.triangles) / (4 * pi / 3);
    area_error[level] = 1 - mesh_area(surface.positions, surface.triangles) / (4 * pi);
  }
  EXPECT_LT(volume_error[2], 2e-3);
  for (int level = 0; level < 2; ++level) {
    EXPECT_NEAR(volume_error[level] / volume_error[level + 1], 4, 0.5);
    EXPECT_NEAR(area_error[level] / area_error[level + 1], 4, 0.8);
  }
}

TEST(MarchingCubes, Torus) {
  const auto torus = [](const Vec3& x) { return 0.3 - std::hypot(std::hypot(x[0], x[1]) - 1, x[2]); };
  const SurfaceGeometry surface = marched(torus, 1.4, 0.04);
  EXPECT_EQ(problems_of(surface), "");
  EXPECT_EQ(euler_characteristic(surface.positions, surface.triangles), 0);
  EXPECT_NEAR(mesh_volume(surface.positions, surface.triangles), 2 * pi * pi * 0.09, 0.005 * 2 * pi * pi * 0.09);
  EXPECT_NEAR(mesh_area(surface.positions, surface.triangles), 4 * pi * pi * 0.3, 0.005 * 4 * pi * pi * 0.3);
}

TEST(SparseGrid, HasTheValuesOfTheField) {
  const FieldSettings settings{2.5, 5, 1.5};
  const MetaballField field(ball_of_particles(4.2, {-3, 100, 7}), {}, settings);
  const SparseGrid grid = grid_of_particles(field.positions(), settings, 0.8);
  int inside = 0;
  for (const SparseGrid::Block& block : grid.blocks()) {
    for (int node = 0; node < SparseGrid::kNodes; ++node) {
      const SparseGrid::Index index{8 * block.place[0] + node / 64, 8 * block.place[1] + node / 8 % 8,
                                    8 * block.place[2] + node % 8};
      ASSERT_NEAR(block.values[node], field.value(grid.position(index)), 1e-11);
      inside += block.values[node] > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(inside, 300);
}

TEST(SparseGrid, MemoryFollowsTheParticlesNotTheirBox) {
  std::vector<Vec3> corners = {{0, 0, 0}, {4000, 4000, 4000}, {-4000, 4000, 0}};
  EXPECT_LE(grid_of_particles(corners, {2.5, 0.5, 1}, 0.8).blocks().size(), 3U * 27U);
}

TEST(SparseGrid, RefusesWhatItCannotHold) {
  EXPECT_THROW(grid_of_particles({{1e12, 0, 0}}, {1, 0.5, 1}, 0.1), std::invalid_argument);
  EXPECT_THROW(grid_of_particles({{std::nan(""), 0, 0}}, {1, 0.5, 1}, 0.1), std::invalid_argument);
  EXPECT_THROW(grid_of_particles({{0, 0, 0}}, {1, 0.5, 1}, 0), std::invalid_argument);
  EXPECT_THROW(grid_of_particles({{0, 0, 0}}, {1, 0, 1}, 0.1), std::invalid_argument);
  EXPECT_THROW(SparseGrid::of_values({2, 2, 2}, {1, 2}, -1, 1), std::invalid_argument);
}

void expect_good(const SurfaceGeometry& surface, const MetaballField& field, double edge_length) {
  EXPECT_EQ(problems_of(surface), "");
  const double radius = field.settings().radius;
  for (const Vec3& x : surface.positions) EXPECT_LE(surface_distance(field, x).distance, 1e-6 * radius);
  const MeshQuality quality = mesh_quality(surface.positions, surface.triangles);
  EXPECT_GT(quality.smallest_angle, 15 * pi / 180);
  EXPECT_GT(quality.mean_smallest_angle, 42 * pi / 180);
  EXPECT_GT(quality.shortest_edge, 0.3 * edge_length);
  EXPECT_LT(quality.longest_edge, 2 * edge_length);
}

TEST(ExtractSurface, IsFitForTracking) {
  for (const double radius : {3.1, 6.3}) {
    const MetaballField field(ball_of_particles(radius), {}, default_field_settings(1));
    const SurfaceGeometry raw = extract_raw_surface(field, 0.8);
    const SurfaceGeometry surface = extract_surface(field, 0.8);
    expect_good(surface, field, 0.8);
    const double volume = mesh_volume(raw.positions, raw.triangles);
    EXPECT_NEAR(mesh_volume(surface.positions, surface.triangles), volume, 0.01 * volume);
    EXPECT_EQ(euler_characteristic(surface.positions, surface.triangles), 2);
  }
}

TEST(ExtractSurface, KeepsAHandle) {
  const std::vector<Vec3> ring =
      test::lattice(1.0, 9, 0.1, 3, [](const Vec3& x) { return std::hypot(std::hypot(x[0], x[1]) - 6, x[2]) <= 2.3; });
  const MetaballField field(ring, {}, default_field_settings(1));
  const SurfaceGeometry surface = extract_surface(field, 0.8);
  expect_good(surface, field, 0.8);
  EXPECT_EQ(euler_characteristic(surface.positions, surface.triangles), 0);
}

TEST(ExtractSurface, SoundOnASprayOfParticles) {
  test::Random random(77);
  std::vector<Vec3> points;
  for (int i = 0; i < 3000; ++i) points.push_back(10 * random.vector());
  const MetaballField field(points, {}, default_field_settings(1));
  const SurfaceGeometry raw = extract_raw_surface(field, 0.8);
  const SurfaceGeometry surface = extract_surface(field, 0.8);
  EXPECT_EQ(problems_of(raw), "");
  EXPECT_EQ(problems_of(surface), "");
  EXPECT_EQ(mesh_components(surface.positions, surface.triangles).count,
            mesh_components(raw.positions, raw.triangles).count);
}

TEST(ExtractSurface, NothingFromParticlesTooWeakForTheThreshold) {
  const MetaballField field({{0, 0, 0}, {10, 0, 0}}, {}, default_field_settings(1));
  EXPECT_TRUE(extract_surface(field, 0.8).positions.empty());
}

TEST(ExtractSurface, SameBytesAtAnyThreadCount) {
  const MetaballField field(ball_of_particles(5.2), {}, default_field_settings(1));
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const SurfaceGeometry one = extract_surface(field, 0.8);
  omp_set_num_threads(3);
  const SurfaceGeometry three = extract_surface(field, 0.8);
  omp_set_num_threads(threads);
  EXPECT_EQ(one.positions, three.positions);
  EXPECT_EQ(one.triangles, three.triangles);
}

}  // namespace
}  // namespace flowskin::tracking::extraction_test
