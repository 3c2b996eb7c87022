// Verlet lists: for each cluster of targets, all sources that may come within the support radius before the next
// rebuild.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sph/point_clusters.h"

namespace flowskin::sph {

/// Lists of single sources for clusters of targets: every source within `radius` of any point of the cluster, in
/// ascending order. The search goes through PointClusters' kd-tree (nanoflann), one query for several clusters; the
/// exact distance test is done eight points at a time.
class NeighborLists {
 public:
  /// Builds the lists anew, in parallel; the result does not depend on the number of threads. `targets` and `sources`
  /// may be the same object: each point is then its own neighbour. Arrays are kept from build to build.
  /// @param period lengths of a periodic box around the origin that holds all points, 0 along axes that are not
  ///        periodic. Distances are then those to the nearest image; no source is listed twice.
  void build(const PointClusters& targets, const PointClusters& sources, float radius,
             const Eigen::Vector3f& period = Eigen::Vector3f::Zero());

  /// Sources near cluster `cluster` of the targets.
  std::span<const std::uint32_t> of_cluster(std::size_t cluster) const {
    const Range& range = ranges_[cluster];
    return {blocks_[cluster / clusters_per_block].data() + range.begin, range.count};
  }

  /// Mean number of entries a cluster.
  double mean_length() const;
  std::size_t memory_bytes() const;

 private:
  template <bool periodic>
  void build_blocks(const PointClusters& targets, const PointClusters& sources, float radius,
                    const Eigen::Vector3f& period);

  static constexpr std::size_t clusters_per_block = 64;
  static constexpr std::size_t clusters_per_query = 8;  // consecutive clusters are close: one kd-tree query for all
  struct Range {
    std::uint32_t begin = 0, count = 0;
  };
  std::vector<Range> ranges_;                       // one a cluster
  std::vector<std::vector<std::uint32_t>> blocks_;  // entries of the clusters of one block: no two threads share one
};

}  // namespace flowskin::sph
