#include "sph/neighbors/hilbert_order.h"

#include <algorithm>
#include <bit>

#include "common/hilbert.h"
#include "common/parallel.h"

namespace flowskin::sph {

void HilbertOrder::compute(const PointView& points, float cell_size, std::vector<char>& scratch) {
  const std::size_t count = points.size();
  order_.resize(count);
  if (count == 0) return;
  scratch.resize(std::max(scratch.size(), count * (2 * sizeof(std::uint64_t) + sizeof(std::uint32_t))));
  auto* keys = reinterpret_cast<std::uint64_t*>(scratch.data());

  Eigen::Vector3f low = points[0], high = points[0];
  for (std::size_t i = 1; i < count; ++i) {
    low = low.cwiseMin(points[i]);
    high = high.cwiseMax(points[i]);
  }
  const float extent = std::max((high - low).maxCoeff(), cell_size);
  const float cells = std::min(extent / cell_size + 1, 2097151.0F);
  const int levels = std::max(1, static_cast<int>(std::bit_width(static_cast<std::uint32_t>(cells))));
  const float scale = (cells - 1) / extent;
#pragma omp parallel for schedule(static) num_threads(threads_for(count))
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3f cell = (points[i] - low) * scale;
    keys[i] = hilbert_index(static_cast<std::uint32_t>(cell.x()), static_cast<std::uint32_t>(cell.y()),
                            static_cast<std::uint32_t>(cell.z()), levels);
    order_[i] = static_cast<std::uint32_t>(i);
  }

  sort_by_key(keys, order_.data(), count, 3 * levels, keys + count, reinterpret_cast<std::uint32_t*>(keys + 2 * count));
}

std::size_t HilbertOrder::memory_bytes() const { return order_.capacity() * sizeof(std::uint32_t); }

}  // namespace flowskin::sph
