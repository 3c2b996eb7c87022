// Holes and parts that only one of two surfaces has are found where they are.
#include "tracking/repair/local_topology.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/tracking/mesh_test_shapes.h"

namespace flowskin::tracking::local_topology_test {
namespace {

const SparseGrid kGrid = SparseGrid::of_values({1, 1, 1}, {-1}, -1, 1);  // of spacing 1
constexpr double kFine = 0.45;

double slab(const Vec3& x) { return std::min({1 - std::abs(x[2]), 5 - std::abs(x[0]), 5 - std::abs(x[1])}); }
double hole_at(const Vec3& x, const Vec3& center) { return (x - center).head<2>().norm() - 1.2; }

CellSet all_around(const Vec3& x, int layers) { return CellSet({cell_at(kGrid.coordinates(x))}).dilated(layers); }

std::vector<CellSet::Cell> differing(const SurfaceGeometry& mesh, const SurfaceGeometry& fresh, const CellSet& where) {
  return LocalTopology(kGrid, mesh.positions, mesh.triangles, fresh).differing(where, 0.75);
}

TEST(LocalTopology, FindsTheHoleThatOneSurfaceLacks) {
  const Vec3 center(1.3, -1.1, 0);
  const SurfaceGeometry whole = test::marched(slab, 6, kFine);
  const SurfaceGeometry pierced =
      test::marched([&](const Vec3& x) { return std::min(slab(x), hole_at(x, center)); }, 6, kFine);
  const CellSet everywhere = all_around(Vec3::Zero(), 6);
  for (const auto& [mesh, fresh] : {std::pair(whole, pierced), std::pair(pierced, whole)}) {
    const CellSet found(differing(mesh, fresh, everywhere));
    EXPECT_TRUE(found.contains(cell_at(kGrid.coordinates(center))));
    EXPECT_TRUE(all_around(center, 3).contains(found));
  }
  EXPECT_TRUE(differing(pierced, pierced, everywhere).empty());
}

TEST(LocalTopology, FindsThePartThatOneSurfaceLacks) {
  const Vec3 center(-3, 2, 4);
  const auto drop = [&](const Vec3& x) { return 0.9 - (x - center).norm(); };
  const SurfaceGeometry alone = test::marched(slab, 6, kFine);
  const SurfaceGeometry with_drop = test::marched([&](const Vec3& x) { return std::max(slab(x), drop(x)); }, 6, kFine);
  const CellSet found(differing(alone, with_drop, all_around(Vec3::Zero(), 6)));
  EXPECT_TRUE(found.contains(cell_at(kGrid.coordinates(center))));
  EXPECT_TRUE(all_around(center, 3).contains(found));
}

TEST(LocalTopology, TheSameSurfaceMeshedOtherwiseDoesNotDiffer) {
  const auto ring = [](const Vec3& x) { return 1.5 - std::hypot(x.head<2>().norm() - 3, x[2]); };
  EXPECT_TRUE(
      differing(test::marched(ring, 6, kFine), test::marched(ring, 6, 0.37), all_around(Vec3::Zero(), 7)).empty());
}

}  // namespace
}  // namespace flowskin::tracking::local_topology_test
