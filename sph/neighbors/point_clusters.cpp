#include "sph/neighbors/point_clusters.h"

#include <algorithm>
#include <nanoflann.hpp>

namespace flowskin::sph {

namespace {

// Collects the indices of everything within a radius; nanoflann's own result set also stores the distances.
class IndexCollector {
 public:
  IndexCollector(float squared_radius, std::vector<std::uint32_t>& found)
      : squared_radius_(squared_radius), found_(found) {}
  bool full() const { return true; }
  std::size_t size() const { return found_.size(); }
  bool addPoint(float squared_distance, std::uint32_t index) {
    if (squared_distance < squared_radius_) found_.push_back(index);
    return true;
  }
  float worstDist() const { return squared_radius_; }

 private:
  float squared_radius_;
  std::vector<std::uint32_t>& found_;
};

}  // namespace

struct PointClusters::Tree {
  // nanoflann's view of the cluster centres.
  struct Cloud {
    const std::vector<PointCluster>* clusters;
    std::size_t kdtree_get_point_count() const { return clusters->size(); }
    float kdtree_get_pt(std::size_t c, std::size_t axis) const {
      const auto a = static_cast<Eigen::Index>(axis);
      return 0.5F * ((*clusters)[c].box_min[a] + (*clusters)[c].box_max[a]);
    }
    template <class Bounds>
    bool kdtree_get_bbox(Bounds&) const {
      return false;
    }
  };

  using Index = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Cloud, float, std::uint32_t>,
                                                    Cloud, 3, std::uint32_t>;

  explicit Tree(const std::vector<PointCluster>& clusters)
      : cloud{&clusters}, index(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(8)) {}
  Cloud cloud;
  Index index;
};

PointClusters::PointClusters() = default;
PointClusters::~PointClusters() = default;
PointClusters::PointClusters(PointClusters&&) noexcept = default;
PointClusters& PointClusters::operator=(PointClusters&&) noexcept = default;

void PointClusters::assign(const PointView& points, float max_extent) {
  point_count_ = points.size();
  clusters_.clear();
  lanes_.clear();
  tree_.reset();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!clusters_.empty() && clusters_.back().count < PointCluster::width) {
      PointCluster& last = clusters_.back();
      const Eigen::Vector3f low = last.box_min.cwiseMin(points[i]), high = last.box_max.cwiseMax(points[i]);
      if ((high - low).maxCoeff() <= max_extent) {
        last.box_min = low;
        last.box_max = high;
        ++last.count;
        continue;
      }
    }
    clusters_.push_back({static_cast<std::uint32_t>(i), 1, points[i], points[i]});
  }
  if (clusters_.empty()) return;

  lanes_.resize(clusters_.size());
  max_half_diagonal_ = 0;
  for (std::size_t c = 0; c < clusters_.size(); ++c) {
    const PointCluster& cluster = clusters_[c];
    max_half_diagonal_ = std::max(max_half_diagonal_, 0.5F * (cluster.box_max - cluster.box_min).norm());
    for (auto& row : lanes_[c]) row.fill(1e18F);
    for (std::uint32_t lane = 0; lane < cluster.count; ++lane) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        lanes_[c][axis][lane] = points[cluster.first + lane][static_cast<Eigen::Index>(axis)];
      }
    }
  }
  tree_ = std::make_unique<Tree>(clusters_);
}

void PointClusters::query(const Eigen::Vector3f& box_min, const Eigen::Vector3f& box_max, float radius,
                          std::vector<std::uint32_t>& found) const {
  found.clear();
  if (!tree_) return;
  const Eigen::Vector3f center = 0.5F * (box_min + box_max);
  // A little more than needed, against rounding; the box test below is the one that counts.
  const float reach = (radius + 0.5F * (box_max - box_min).norm() + max_half_diagonal_) * 1.0001F;
  IndexCollector collector(reach * reach, found);
  tree_->index.findNeighbors(collector, center.data(), nanoflann::SearchParams());
  const float squared_radius = radius * radius;
  std::erase_if(found,
                [&](std::uint32_t c) { return clusters_[c].squared_distance(box_min, box_max) > squared_radius; });
  std::sort(found.begin(), found.end());
}

std::vector<Eigen::Vector3f> PointClusters::points() const {
  std::vector<Eigen::Vector3f> points;
  points.reserve(point_count_);
  for (std::size_t c = 0; c < clusters_.size(); ++c) {
    for (std::uint32_t lane = 0; lane < clusters_[c].count; ++lane) points.push_back(point(c, lane));
  }
  return points;
}

std::size_t PointClusters::memory_bytes() const {
  std::size_t bytes = clusters_.capacity() * sizeof(PointCluster) + lanes_.capacity() * sizeof(Lanes);
  if (tree_) bytes += sizeof(Tree) + tree_->index.usedMemory(tree_->index);
  return bytes;
}

}  // namespace flowskin::sph
