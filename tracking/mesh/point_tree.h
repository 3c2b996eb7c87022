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

/// Points of a surface with its normals there, of length 1; keeps references.
struct SurfacePoints {
  const std::vector<Vec3>& places;
  const std::vector<Vec3>& normals;
};

/// For each point of the second surface the one of the first that it pairs with, -1: none. Points are candidates for
/// each other where they are nearer than `reach` (m) and their normals make an angle with a cosine above `cosine`; each
/// of a pair is the other's nearest candidate.
std::vector<int> paired_points(const SurfacePoints& first, const SurfacePoints& second, double reach, double cosine);

}  // namespace flowskin::tracking
