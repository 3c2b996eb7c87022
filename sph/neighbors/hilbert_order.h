// Order of points along a Hilbert curve: points that follow each other are close in space and in memory.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "sph/neighbors/point_view.h"

namespace flowskin::sph {

/// Sorts points along a Hilbert curve.
class HilbertOrder {
 public:
  /// order()[k] is the index of the point that becomes the k-th. Points of one cell keep their order.
  /// @param cell_size edge of the curve's cells, in the unit of the points; made larger where 2^21 cells do not reach
  /// @param scratch is used on the way and grows to at least 20 bytes per point
  void compute(const PointView& points, float cell_size, std::vector<char>& scratch);
  void compute(const PointView& points, float cell_size) {
    std::vector<char> scratch;
    compute(points, cell_size, scratch);
  }
  const std::vector<std::uint32_t>& order() const { return order_; }
  std::size_t memory_bytes() const;

 private:
  std::vector<std::uint32_t> order_;
};

}  // namespace flowskin::sph
