#include "sph/neighbors/neighbor_lists.h"

#include <algorithm>

#include "common/parallel.h"
#include "sph/pairs/lanes.h"

namespace flowskin::sph {

namespace {

// The periodic box in the search: lengths (0 along axes that are not periodic) and their inverses.
struct Period {
  explicit Period(const Eigen::Vector3f& lengths) : length(lengths) {
    for (int a = 0; a < 3; ++a) inverse[a] = length[a] > 0 ? 1 / length[a] : 0;
  }
  Float8 shortest(const Float8& difference, int axis) const {
    return difference - broadcast(length[axis]) * round8(difference * broadcast(inverse[axis]));
  }
  Eigen::Vector3f shortest(const Eigen::Vector3f& d) const {
    return d - length.cwiseProduct(d.cwiseProduct(inverse).array().round().matrix());
  }
  Eigen::Vector3f length, inverse;
};

// Appends the points of `source` that lie within the radius of any point of `target`.
template <bool periodic>
void append_near(const PointClusters::Lanes& target, std::uint32_t target_count, const PointClusters::Lanes& source,
                 const PointCluster& source_cluster, float squared_radius, const Period& period,
                 std::vector<std::uint32_t>& entries) {
  const Float8 x = load8(source[0].data()), y = load8(source[1].data()), z = load8(source[2].data());
  Float8 nearest = broadcast(1e37F);
  for (std::uint32_t lane = 0; lane < target_count; ++lane) {
    Float8 dx = x - broadcast(target[0][lane]);
    Float8 dy = y - broadcast(target[1][lane]);
    Float8 dz = z - broadcast(target[2][lane]);
    if constexpr (periodic) dx = period.shortest(dx, 0), dy = period.shortest(dy, 1), dz = period.shortest(dz, 2);
    nearest = min(nearest, dx * dx + dy * dy + dz * dz);
  }
  const unsigned mask = less_mask(nearest, broadcast(squared_radius));
  for (std::uint32_t lane = 0; lane < source_cluster.count; ++lane) {
    if ((mask >> lane) & 1U) entries.push_back(source_cluster.first + lane);
  }
}

// Squared distance of the boxes of two clusters, or of one to the nearest image of the other.
template <bool periodic>
float squared_distance(const PointCluster& a, const PointCluster& b, const Period& period) {
  if constexpr (!periodic) return a.squared_distance(b.box_min, b.box_max);
  const Eigen::Vector3f centers = period.shortest(0.5F * (a.box_min + a.box_max - b.box_min - b.box_max));
  const Eigen::Vector3f half_sizes = 0.5F * (a.box_max - a.box_min + b.box_max - b.box_min);
  return (centers.cwiseAbs() - half_sizes).cwiseMax(Eigen::Vector3f::Zero()).squaredNorm();
}

// Appends the list of one cluster of targets, out of candidate clusters of sources.
template <bool periodic>
void append_lists(const PointClusters& targets, std::size_t target, const PointClusters& sources,
                  const std::vector<std::uint32_t>& candidates, float squared_radius, const Period& period,
                  std::vector<std::uint32_t>& entries) {
  const PointCluster& cluster = targets[target];
  for (const std::uint32_t s : candidates) {
    if (squared_distance<periodic>(sources[s], cluster, period) > squared_radius) continue;
    append_near<periodic>(targets.lanes(target), cluster.count, sources.lanes(s), sources[s], squared_radius, period,
                          entries);
  }
}

// The clusters within reach of a box or of one of its images, each once, in ascending order.
void query_images(const PointClusters& sources, const Eigen::Vector3f& low, const Eigen::Vector3f& high, float radius,
                  const Period& period, std::vector<std::uint32_t>& image, std::vector<std::uint32_t>& found) {
  // All points lie in the periodic box, so only an image shifted towards it can reach something.
  Eigen::Array3i first = Eigen::Array3i::Zero(), last = first;
  for (int a = 0; a < 3; ++a) {
    if (period.length[a] == 0) continue;
    if (low[a] - radius < -0.5F * period.length[a]) last[a] = 1;
    if (high[a] + radius > 0.5F * period.length[a]) first[a] = -1;
  }
  found.clear();
  for (int i = first[0]; i <= last[0]; ++i) {
    for (int j = first[1]; j <= last[1]; ++j) {
      for (int k = first[2]; k <= last[2]; ++k) {
        const Eigen::Vector3f shift = period.length.cwiseProduct(Eigen::Vector3i(i, j, k).cast<float>());
        sources.query(low + shift, high + shift, radius, image);
        found.insert(found.end(), image.begin(), image.end());
      }
    }
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
}

}  // namespace

void NeighborLists::build(const PointClusters& targets, const PointClusters& sources, float radius,
                          const Eigen::Vector3f& period, const Sight& sight) {
  period.isZero(0) ? build_blocks<false>(targets, sources, radius, period, sight)
                   : build_blocks<true>(targets, sources, radius, period, sight);
}

// The entries of a cluster, which are the last ones: first those that all lanes see, then those that some see, in
// order of who does. Those that nobody sees are dropped.
void NeighborLists::sort_by_sight(const PointClusters& targets, std::size_t cluster,
                                  const std::vector<std::uint8_t>& hidden, std::vector<std::uint32_t>& entries) {
  const unsigned nobody = (1U << targets[cluster].count) - 1;
  const std::size_t begin = ranges_[cluster].begin;
  std::vector<std::pair<unsigned, std::uint32_t>> partly;
  std::size_t end = begin;
  for (std::size_t k = 0; k < hidden.size(); ++k) {
    const std::uint32_t entry = entries[begin + k];
    if (hidden[k] == 0) {
      entries[end++] = entry;
    } else if (hidden[k] != nobody) {
      partly.emplace_back(hidden[k], entry);
    }
  }
  entries.resize(end);
  ranges_[cluster].count = static_cast<std::uint32_t>(end - begin);
  std::sort(partly.begin(), partly.end());
  std::vector<HiddenRange>& parts = parts_[cluster / clusters_per_block];
  for (const auto& [lanes, entry] : partly) {
    if (part_ranges_[cluster].count == 0 || parts.back().hidden != lanes) {
      parts.push_back({static_cast<std::uint32_t>(entries.size()), 0, lanes});
      ++part_ranges_[cluster].count;
    }
    entries.push_back(entry);
    ++parts.back().count;
  }
}

template <bool periodic>
void NeighborLists::build_blocks(const PointClusters& targets, const PointClusters& sources, float radius,
                                 const Eigen::Vector3f& lengths, const Sight& sight) {
  ranges_.resize(targets.size());
  blocks_.resize((targets.size() + clusters_per_block - 1) / clusters_per_block);
  part_ranges_.assign(sight ? targets.size() : 0, {});
  parts_.resize(sight ? blocks_.size() : 0);
  const Period period(lengths);
  // Everything below compares float distances; this much more makes sure that nothing within the radius is missed.
  const float padded = radius * (1 + 1e-5F) + 1e-6F * lengths.maxCoeff();
#pragma omp parallel num_threads(threads_for(targets.point_count()))
  {
    // Each thread collects the entries of a block here, so that the blocks themselves have no room to spare.
    std::vector<std::uint32_t> candidates, image, entries;
    std::vector<std::uint8_t> hidden;
#pragma omp for schedule(dynamic)
    for (std::size_t block = 0; block < blocks_.size(); ++block) {
      entries.clear();
      if (sight) parts_[block].clear();
      const std::size_t end = std::min(targets.size(), (block + 1) * clusters_per_block);
      for (std::size_t first = block * clusters_per_block; first < end; first += clusters_per_query) {
        const std::size_t last = std::min(end, first + clusters_per_query);
        Eigen::Vector3f low = targets[first].box_min, high = targets[first].box_max;
        for (std::size_t c = first; c < last; ++c) {
          low = low.cwiseMin(targets[c].box_min);
          high = high.cwiseMax(targets[c].box_max);
        }
        if constexpr (periodic) {
          query_images(sources, low, high, padded, period, image, candidates);
        } else {
          sources.query(low, high, padded, candidates);
        }
        for (std::size_t c = first; c < last; ++c) {
          const std::size_t begin = entries.size();
          append_lists<periodic>(targets, c, sources, candidates, padded * padded, period, entries);
          ranges_[c] = {static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(entries.size() - begin)};
          if (!sight) continue;
          part_ranges_[c].begin = static_cast<std::uint32_t>(parts_[block].size());
          hidden.assign(entries.size() - begin, 0);
          if (sight(c, std::span(entries).subspan(begin), hidden)) sort_by_sight(targets, c, hidden, entries);
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
  bytes += part_ranges_.capacity() * sizeof(Range) + parts_.capacity() * sizeof(decltype(parts_)::value_type);
  for (const auto& parts : parts_) bytes += parts.capacity() * sizeof(HiddenRange);
  return bytes;
}

}  // namespace flowskin::sph
