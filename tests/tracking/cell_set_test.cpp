// Sets of cells against the plain way to make them.
#include "tracking/extraction/cell_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <vector>

namespace flowskin::tracking::cell_set_test {
namespace {

using Cell = CellSet::Cell;

CellSet random_cells(int count, int size, unsigned seed) {
  std::mt19937 random(seed);
  const auto coordinate = [&] { return static_cast<int>(random() % static_cast<unsigned>(size)) - size / 2; };
  std::vector<Cell> cells;
  for (int i = 0; i < count; ++i) cells.push_back({coordinate(), coordinate(), coordinate()});
  return CellSet(cells);
}

void expect_same(const CellSet& found, const CellSet& expected) {
  EXPECT_EQ(found.cells(), expected.cells());
  EXPECT_EQ(found.low(), expected.low());
  EXPECT_EQ(found.high(), expected.high());
}

TEST(CellSet, DilatedHasAllCellsAround) {
  for (int layers = 0; layers < 6; ++layers) {
    const CellSet cells = random_cells(40, 20, 5);
    std::vector<Cell> around;
    for (const Cell& cell : cells.cells()) {
      for (int i = -layers; i <= layers; ++i) {
        for (int j = -layers; j <= layers; ++j) {
          for (int k = -layers; k <= layers; ++k) around.push_back({cell[0] + i, cell[1] + j, cell[2] + k});
        }
      }
    }
    expect_same(cells.dilated(layers), CellSet(around));
  }
  EXPECT_TRUE(CellSet().dilated(3).empty());
}

TEST(CellSet, UnionAndInclusion) {
  const CellSet first = random_cells(60, 9, 1), second = random_cells(50, 12, 2);
  std::vector<Cell> all = first.cells();
  all.insert(all.end(), second.cells().begin(), second.cells().end());
  const CellSet both = first.united(second);
  expect_same(both, CellSet(all));
  EXPECT_TRUE(both.contains(first) && both.contains(second) && !first.contains(both));
  expect_same(first.united(CellSet()), first);
  expect_same(CellSet().united(first), first);
  EXPECT_TRUE(first.contains(CellSet()));
}

TEST(CellSet, BoxesMeetTheCellsThatTheyOverlap) {
  const CellSet cells = random_cells(80, 12, 3);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> place(-7, 7), extent(0, 3);
  int met = 0;
  for (int i = 0; i < 500; ++i) {
    const Vec3 low(place(random), place(random), place(random));
    const Vec3 high = low + Vec3(extent(random), extent(random), extent(random));
    const bool expected = std::any_of(cells.cells().begin(), cells.cells().end(), [&](const Cell& cell) {
      const Vec3 corner(cell[0], cell[1], cell[2]);
      return (low.array() < corner.array() + 1).all() && (high.array() >= corner.array()).all();
    });
    EXPECT_EQ(meets(cells, low, high), expected);
    met += expected;
  }
  EXPECT_GT(met, 50);
  EXPECT_LT(met, 450);
}

TEST(CellSet, ComponentsHangTogetherAtCorners) {
  const std::vector<CellSet> parts = CellSet({{0, 0, 0}, {1, 1, 1}, {5, 0, 0}, {5, 0, 1}, {3, 1, 1}}).components();
  ASSERT_EQ(parts.size(), 3U);
  EXPECT_EQ(parts[0].cells().size(), 2U);
  EXPECT_EQ(parts[1].cells().size(), 1U);
  EXPECT_EQ(parts[2].cells().size(), 2U);
}

}  // namespace
}  // namespace flowskin::tracking::cell_set_test
