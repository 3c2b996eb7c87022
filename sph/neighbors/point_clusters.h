// Points in groups of up to eight that lie close together, with a kd-tree over the groups.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "sph/neighbors/point_view.h"

namespace flowskin::sph {

/// Consecutive points that are handled together: one SIMD lane each.
struct PointCluster {
  static constexpr int width = 8;
  std::uint32_t first = 0;  ///< Index of the first point.
  std::uint32_t count = 0;  ///< 1 to width
  Eigen::Vector3f box_min, box_max;

  /// Squared distance from this cluster's box to another box; 0 where they touch.
  float squared_distance(const Eigen::Vector3f& other_min, const Eigen::Vector3f& other_max) const {
    const Eigen::Vector3f gap = (box_min - other_max).cwiseMax(other_min - box_max).cwiseMax(Eigen::Vector3f::Zero());
    return gap.squaredNorm();
  }
};

/// Splits points, given in the order of a space-filling curve, into clusters of at most eight consecutive points.
class PointClusters {
 public:
  PointClusters();
  ~PointClusters();
  PointClusters(PointClusters&&) noexcept;
  PointClusters& operator=(PointClusters&&) noexcept;

  /// @param points in the order of a space-filling curve
  /// @param max_extent no cluster's box is longer than this along any axis, so that one stray point cannot make a
  ///        cluster that is near everything
  void assign(const PointView& points, float max_extent);

  std::size_t size() const { return clusters_.size(); }
  const PointCluster& operator[](std::size_t c) const { return clusters_[c]; }
  std::size_t point_count() const { return point_count_; }

  /// Coordinates of cluster c as they were in assign(): lane k of row a is coordinate a of point k. Lanes without a
  /// point are 1e18 away from everything.
  using Lanes = std::array<std::array<float, PointCluster::width>, 3>;
  const Lanes& lanes(std::size_t c) const { return lanes_[c]; }
  Eigen::Vector3f point(std::size_t c, std::uint32_t lane) const {
    return {lanes_[c][0][lane], lanes_[c][1][lane], lanes_[c][2][lane]};
  }

  /// All points as they were in assign().
  std::vector<Eigen::Vector3f> points() const;

  /// Replaces `found` by the clusters whose box comes within `radius` of the box given, in ascending order.
  void query(const Eigen::Vector3f& box_min, const Eigen::Vector3f& box_max, float radius,
             std::vector<std::uint32_t>& found) const;

  std::size_t memory_bytes() const;

 private:
  struct Tree;
  std::size_t point_count_ = 0;
  float max_half_diagonal_ = 0;
  std::vector<PointCluster> clusters_;
  std::vector<Lanes> lanes_;
  std::unique_ptr<Tree> tree_;
};

}  // namespace flowskin::sph
