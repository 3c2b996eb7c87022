#include "sph/neighbor_lists.h"

#include <algorithm>

#include "sph/parallel.h"
#include "sph/simd.h"

namespace flowskin::sph {

namespace {

// Appends the points of `source` that lie within the radius of any point of `target`.
void append_near(const PointClusters::Lanes& target, std::uint32_t target_count, const PointClusters::Lanes& source,
                 const PointCluster& source_cluster, float squared_radius, std::vector<std::uint32_t>& entries) {
  const Float8 x = load8(source[0].data()), y = load8(source[1].data()), z = load8(source[2].data());
  Float8 nearest = broadcast(1e37F);
  for (std::uint32_t lane = 0; lane < target_count; ++lane) {
    const Float8 dx = x - broadcast(target[0][lane]);
    const Float8 dy = y - broadcast(target[1][lane]);
    const Float8 dz = z - broadcast(target[2][lane]);
    nearest = min(nearest, dx * dx + dy * dy + dz * dz);
  }
  const unsigned mask = less_mask(nearest, broadcast(squared_radius));
  for (std::uint32_t lane = 0; lane < source_cluster.count; ++lane) {
    if ((mask >> lane) & 1U) entries.push_back(source_cluster.first + lane);
  }
}

// Appends the list of one cluster of targets, out of candidate clusters of sources.
void append_lists(const PointClusters& targets, std::size_t target, const PointClusters& sources,
                  const std::vector<std::uint32_t>& candidates, float squared_radius,
                  std::vector<std::uint32_t>& entries) {
  const PointCluster& cluster = targets[target];
  for (const std::uint32_t s : candidates) {
    if (sources[s].squared_distance(cluster.box_min, cluster.box_max) > squared_radius) continue;
    append_near(targets.lanes(target), cluster.count, sources.lanes(s), sources[s], squared_radius, entries);
  }
}

}  // namespace

void NeighborLists::build(const PointClusters& targets, const PointClusters& sources, float radius) {
  ranges_.resize(targets.size());
  blocks_.resize((targets.size() + clusters_per_block - 1) / clusters_per_block);
  // Everything below compares float distances; this much more makes sure that nothing within the radius is missed.
  const float padded = radius * (1 + 1e-5F);
#pragma omp parallel num_threads(threads_for(targets.point_count()))
  {
    // Each thread collects the entries of a block here, so that the blocks themselves have no room to spare.
    std::vector<std::uint32_t> candidates, entries;
#pragma omp for schedule(dynamic)
    for (std::size_t block = 0; block < blocks_.size(); ++block) {
      entries.clear();
      const std::size_t end = std::min(targets.size(), (block + 1) * clusters_per_block);
      for (std::size_t first = block * clusters_per_block; first < end; first += clusters_per_query) {
        const std::size_t last = std::min(end, first + clusters_per_query);
        Eigen::Vector3f low = targets[first].box_min, high = targets[first].box_max;
        for (std::size_t c = first; c < last; ++c) {
          low = low.cwiseMin(targets[c].box_min);
          high = high.cwiseMax(targets[c].box_max);
        }
        sources.query(low, high, padded, candidates);
        for (std::size_t c = first; c < last; ++c) {
          const std::size_t begin = entries.size();
          append_lists(targets, c, sources, candidates, padded * padded, entries);
          ranges_[c] = {static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(entries.size() - begin)};
        }
      }
      std::vector<std::uint32_t>& kept = blocks_[block];
      if (kept.capacity() < entries.size() || kept.capacity() > entries.size() + entries.size() / 8) {
        kept = std::vector<std::uint32_t>(entries.begin(), entries.end());
      } else {
        kept.assign(entries.begin(), entries.end());
      }
    }
  }
}

double NeighborLists::mean_length() const {
  std::size_t sum = 0;
  for (const Range& range : ranges_) sum += range.count;
  return ranges_.empty() ? 0 : static_cast<double>(sum) / static_cast<double>(ranges_.size());
}

std::size_t NeighborLists::memory_bytes() const {
  std::size_t bytes = ranges_.capacity() * sizeof(Range) + blocks_.capacity() * sizeof(decltype(blocks_)::value_type);
  for (const auto& block : blocks_) bytes += block.capacity() * sizeof(std::uint32_t);
  return bytes;
}

}  // namespace flowskin::sph
