// A nanoflann k-d tree over points.
#pragma once

#include <cstddef>
#include <nanoflann.hpp>
#include <vector>

#include "tracking/particles.h"

namespace flowskin::tracking {

/// Points as nanoflann wants them; keeps a reference.
struct PointCloud {
  const std::vector<Vec3>& points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t index, std::size_t axis) const { return points[index][static_cast<int>(axis)]; }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};
using PointTree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, PointCloud>, PointCloud, 3, int>;

/// Number of the nearest one of `targets` for each query, -1 where none is within reach (m).
std::vector<int> nearest_points(const std::vector<Vec3>& targets, const std::vector<Vec3>& queries, double reach);

}  // namespace flowskin::tracking
