// Whatever meets a box is among the triangles near it.
#include "tracking/repair/triangle_bins.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace flowskin::tracking::triangle_bins_test {
namespace {

Box random_box(std::mt19937& random, double largest) {
  std::uniform_real_distribution<double> place(-60, 60), extent(0, largest);
  const Vec3 low(place(random), place(random), place(random));
  return {low, low + Vec3(extent(random), extent(random), extent(random))};
}

TEST(TriangleBins, NearHoldsAllThatMeetABoxInOrder) {
  std::mt19937 random(3);
  TriangleBins bins;
  std::vector<Box> boxes;
  for (int t = 0; t < 2000; ++t) {
    boxes.push_back(random_box(random, 12));
    bins.add(t, boxes.back());
  }
  std::size_t met = 0, found = 0;
  for (int i = 0; i < 100; ++i) {
    const Box box = random_box(random, 20);
    const std::vector<int> near = bins.near(box);
    EXPECT_TRUE(std::is_sorted(near.begin(), near.end()));
    EXPECT_EQ(std::adjacent_find(near.begin(), near.end()), near.end());
    found += near.size();
    for (int t = 0; t < 2000; ++t) {
      if (!boxes[t].overlaps(box)) continue;
      ++met;
      EXPECT_TRUE(std::binary_search(near.begin(), near.end(), t)) << t;
    }
  }
  EXPECT_GT(met, 300U);
  EXPECT_LT(found, 10 * met);
}

TEST(TriangleBins, EmptyOnesAreNearNothing) {
  EXPECT_TRUE(TriangleBins().near({Vec3(-1, -1, -1), Vec3(1, 1, 1)}).empty());
}

}  // namespace
}  // namespace flowskin::tracking::triangle_bins_test
