// Neighbour lists against brute force.
#include "sph/neighbors/neighbor_lists.h"
#include "common/hilbert.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "sph/neighbors/hilbert_order.h"
#include "tests/sph/test_meshes.h"

namespace flowskin::sph::neighbor_lists_test {
namespace {

using Points = std::vector<Eigen::Vector3f>;

Points sorted_along_curve(const Points& points, float cell) {
  HilbertOrder curve;
  curve.compute(points, cell);
  Points sorted;
  for (const std::uint32_t i : curve.order()) sorted.push_back(points[i]);
  return sorted;
}

Points random_points(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  Points points(count);
  for (auto& p : points) p = random.vector().cast<float>();
  return points;
}

// Every pair within the radius is listed, nothing is listed twice, and what is listed is within the radius of some
// lane.
void expect_right_lists(const Points& targets, const Points& sources, float radius, float max_extent) {
  PointClusters target_clusters, source_clusters;
  target_clusters.assign(targets, max_extent);
  source_clusters.assign(sources, max_extent);
  NeighborLists lists;
  lists.build(target_clusters, source_clusters, radius);
  std::size_t covered = 0;
  for (std::size_t c = 0; c < target_clusters.size(); ++c) {
    const PointCluster& cluster = target_clusters[c];
    EXPECT_EQ(cluster.first, covered);
    covered += cluster.count;
    const auto entries = lists.of_cluster(c);
    EXPECT_TRUE(std::is_sorted(entries.begin(), entries.end()));
    const std::set<std::uint32_t> listed(entries.begin(), entries.end());
    EXPECT_EQ(listed.size(), entries.size());
    for (std::uint32_t s = 0; s < sources.size(); ++s) {
      float nearest = 1e30F;
      for (std::uint32_t k = 0; k < cluster.count; ++k) {
        nearest = std::min(nearest, (targets[cluster.first + k] - sources[s]).norm());
      }
      const bool is_listed = listed.count(s) > 0;
      EXPECT_TRUE(is_listed || nearest >= radius) << "missed at " << nearest;
      EXPECT_TRUE(!is_listed || nearest <= 1.0001F * radius) << "too far at " << nearest;
    }
  }
  EXPECT_EQ(covered, targets.size());
}

TEST(NeighborLists, RandomPoints) {
  const Points points = sorted_along_curve(random_points(1500, 1), 0.1F);
  for (const float radius : {0.05F, 0.2F, 3.0F}) expect_right_lists(points, points, radius, 0.3F);
}

TEST(NeighborLists, HiddenSourcesAreSeenByTheOthersOnly) {
  // Whether a pair sees each other is a number of the two: each pair of the plain lists comes up once or never.
  const Points points = sorted_along_curve(random_points(1500, 4), 0.1F);
  PointClusters clusters;
  clusters.assign(points, 0.3F);
  const auto sees = [](std::size_t a, std::size_t b) { return a == b || (a * b + a + b) % 3 != 0; };
  const auto sight = [&](std::size_t c, std::span<const std::uint32_t> sources, std::vector<std::uint8_t>& hidden) {
    if (c % 5 == 0) return false;
    for (std::size_t s = 0; s < sources.size(); ++s) {
      for (std::uint32_t k = 0; k < clusters[c].count; ++k) {
        if (!sees(clusters[c].first + k, sources[s])) hidden[s] = static_cast<std::uint8_t>(hidden[s] | 1U << k);
      }
    }
    return true;
  };
  NeighborLists plain, lists;
  plain.build(clusters, clusters, 0.15F);
  for (int build = 0; build < 2; ++build) lists.build(clusters, clusters, 0.15F, Eigen::Vector3f::Zero(), sight);
  std::size_t parts = 0;
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    parts += lists.part_count(c) - 1;
    for (std::uint32_t k = 0; k < clusters[c].count; ++k) {
      std::vector<std::uint32_t> wanted, seen;
      for (const std::uint32_t s : plain.of_cluster(c)) {
        if (c % 5 == 0 || sees(clusters[c].first + k, s)) wanted.push_back(s);
      }
      for (std::size_t part = 0; part < lists.part_count(c); ++part) {
        const NeighborLists::Part list = lists.part(c, part);
        if ((list.hidden >> k & 1U) == 0) seen.insert(seen.end(), list.sources.begin(), list.sources.end());
      }
      std::sort(seen.begin(), seen.end());
      EXPECT_EQ(seen, wanted);
    }
  }
  EXPECT_GT(parts, clusters.size());
}

TEST(NeighborLists, ClusteredPoints) {
  Points points = random_points(1200, 2);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = points[i] * 0.05F + Eigen::Vector3f::Constant(static_cast<float>(i % 7) * 3.0F);
  }
  points = sorted_along_curve(points, 0.01F);
  expect_right_lists(points, points, 0.02F, 0.05F);
}

TEST(NeighborLists, DegenerateSets) {
  const Eigen::Vector3f p(1, 2, 3);
  expect_right_lists({}, {}, 1, 1);
  expect_right_lists({p}, {p}, 1, 1);
  expect_right_lists({p}, {}, 1, 1);
  expect_right_lists({}, {p}, 1, 1);
  const Points same(100, p);
  expect_right_lists(same, same, 0.5F, 1);
  Points line;
  for (int i = 0; i < 100; ++i) line.emplace_back(static_cast<float>(i), 0.0F, 0.0F);
  expect_right_lists(line, line, 2.5F, 3);
}

TEST(NeighborLists, TargetsAndSourcesMayDiffer) {
  const Points targets = sorted_along_curve(random_points(400, 3), 0.1F);
  const Points sources = sorted_along_curve(random_points(700, 4), 0.1F);
  expect_right_lists(targets, sources, 0.15F, 0.3F);
}

TEST(NeighborLists, RebuildingKeepsMemory) {
  const Points points = sorted_along_curve(random_points(3000, 5), 0.07F);
  PointClusters clusters;
  NeighborLists lists;
  std::size_t bytes = 0;
  for (int k = 0; k < 20; ++k) {
    clusters.assign(points, 0.3F);
    lists.build(clusters, clusters, 0.15F);
    const std::size_t now = clusters.memory_bytes() + lists.memory_bytes();
    if (k == 0) bytes = now;
    EXPECT_EQ(now, bytes);
  }
}

TEST(HilbertOrder, NeighbouringCellsFollowEachOther) {
  // The curve visits each cell once and goes to a face neighbour every time.
  constexpr int levels = 3, edge = 1 << levels;
  std::vector<Eigen::Vector3i> cells(edge * edge * edge, Eigen::Vector3i::Constant(-1));
  for (int x = 0; x < edge; ++x) {
    for (int y = 0; y < edge; ++y) {
      for (int z = 0; z < edge; ++z) {
        const std::uint64_t index = hilbert_index(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                                                  static_cast<std::uint32_t>(z), levels);
        ASSERT_LT(index, cells.size());
        EXPECT_EQ(cells[index].x(), -1);
        cells[index] = {x, y, z};
      }
    }
  }
  for (std::size_t k = 1; k < cells.size(); ++k) EXPECT_EQ((cells[k] - cells[k - 1]).cwiseAbs().sum(), 1);
}

TEST(HilbertOrder, IsAPermutationAndStable) {
  Points points = random_points(500, 6);
  points.resize(600, points[3]);
  HilbertOrder curve;
  curve.compute(points, 0.05F);
  std::vector<std::uint32_t> order = curve.order();
  std::vector<std::uint32_t> same_place;
  for (const std::uint32_t i : order) {
    if (i >= 500) same_place.push_back(i);
  }
  EXPECT_TRUE(std::is_sorted(same_place.begin(), same_place.end()));
  std::sort(order.begin(), order.end());
  for (std::uint32_t i = 0; i < order.size(); ++i) EXPECT_EQ(order[i], i);
}

}  // namespace
}  // namespace flowskin::sph::neighbor_lists_test
