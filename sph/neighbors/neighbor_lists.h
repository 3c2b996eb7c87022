// Verlet lists: for each cluster of targets, all sources that may come within the support radius before the next
// rebuild.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "sph/neighbors/point_clusters.h"

namespace flowskin::sph {

/// Lists of single sources for clusters of targets: every source within `radius` of any point of the cluster, in
/// ascending order. The search goes through PointClusters' kd-tree (nanoflann), one query for several clusters; the
/// exact distance test is done eight points at a time.
class NeighborLists {
 public:
  /// Sets bit k of hidden[j], zero before, where target k of the cluster does not see sources[j]; false where all see
  /// all.
  using Sight = std::function<bool(std::size_t cluster, std::span<const std::uint32_t> sources,
                                   std::vector<std::uint8_t>& hidden)>;

  /// Builds the lists anew, in parallel; the result does not depend on the number of threads. `targets` and `sources`
  /// may be the same object: each point is then its own neighbour. Arrays are kept from build to build.
  /// @param period lengths of a periodic box around the origin that holds all points, 0 along axes that are not
  ///        periodic. Distances are then those to the nearest image; no source is listed twice.
  /// @param sight says which pairs do not see each other; called in parallel. Empty: all do.
  void build(const PointClusters& targets, const PointClusters& sources, float radius,
             const Eigen::Vector3f& period = Eigen::Vector3f::Zero(), const Sight& sight = {});

  /// A list in parts: the first one is of_cluster(), sources that the whole cluster sees; then, where walls are in the
  /// way, sources hidden from the lanes whose bits are set.
  struct Part {
    std::span<const std::uint32_t> sources;
    unsigned hidden = 0;
  };
  std::size_t part_count(std::size_t cluster) const {
    return 1 + (part_ranges_.empty() ? 0 : part_ranges_[cluster].count);
  }
  Part part(std::size_t cluster, std::size_t k) const {
    if (k == 0) return {of_cluster(cluster), 0};
    const std::size_t block = cluster / clusters_per_block;
    const HiddenRange& range = parts_[block][part_ranges_[cluster].begin + k - 1];
    return {{blocks_[block].data() + range.begin, range.count}, range.hidden};
  }

  /// Sources near cluster `cluster` of the targets; where there is a sight, those that all of its lanes see.
  std::span<const std::uint32_t> of_cluster(std::size_t cluster) const {
    const Range& range = ranges_[cluster];
    return {blocks_[cluster / clusters_per_block].data() + range.begin, range.count};
  }

  /// Mean number of entries per cluster.
  double mean_length() const;
  std::size_t memory_bytes() const;

 private:
  template <bool periodic>
  void build_blocks(const PointClusters& targets, const PointClusters& sources, float radius,
                    const Eigen::Vector3f& period, const Sight& sight);
  void sort_by_sight(const PointClusters& targets, std::size_t cluster, const std::vector<std::uint8_t>& hidden,
                     std::vector<std::uint32_t>& entries);

  static constexpr std::size_t clusters_per_block = 64;
  static constexpr std::size_t clusters_per_query = 8;  // consecutive clusters are close: one kd-tree query for all
  struct Range {
    std::uint32_t begin = 0, count = 0;
  };
  struct HiddenRange {
    std::uint32_t begin = 0, count = 0, hidden = 0;
  };
  std::vector<Range> ranges_;                       // one per cluster
  std::vector<std::vector<std::uint32_t>> blocks_;  // entries of the clusters of one block: no two threads share one
  std::vector<Range> part_ranges_;                  // in the parts of the block; one per cluster, empty without sight
  std::vector<std::vector<HiddenRange>> parts_;     // of the clusters of one block
};

}  // namespace flowskin::sph
