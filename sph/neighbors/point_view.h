// Read access to the places of points, wherever they are kept.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "sph/pairs/particle_pack.h"

namespace flowskin::sph {

/// The places of points that lie in memory at a fixed stride: plain vectors, or packs, which begin with their place.
class PointView {
 public:
  PointView(std::span<const Eigen::Vector3f> points)  // NOLINT(google-explicit-constructor): made to be converted to
      : first_(reinterpret_cast<const float*>(points.data())), stride_(3), count_(points.size()) {}
  PointView(const std::vector<Eigen::Vector3f>& points)  // NOLINT(google-explicit-constructor)
      : PointView(std::span(points)) {}
  PointView(std::span<const FluidPack> packs)  // NOLINT(google-explicit-constructor)
      : first_(reinterpret_cast<const float*>(packs.data())),
        stride_(sizeof(FluidPack) / sizeof(float)),
        count_(packs.size()) {}

  PointView(const std::vector<WallPack>& packs)  // NOLINT(google-explicit-constructor)
      : first_(reinterpret_cast<const float*>(packs.data())),
        stride_(sizeof(WallPack) / sizeof(float)),
        count_(packs.size()) {}

  std::size_t size() const { return count_; }
  bool empty() const { return count_ == 0; }
  Eigen::Vector3f operator[](std::size_t i) const { return Eigen::Vector3f(first_ + i * stride_); }

 private:
  const float* first_;
  std::size_t stride_, count_;
};

}  // namespace flowskin::sph
