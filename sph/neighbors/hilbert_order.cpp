#include "sph/neighbors/hilbert_order.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <utility>

#include "sph/parallel.h"

namespace flowskin::sph {

std::uint64_t hilbert_index(std::uint32_t x, std::uint32_t y, std::uint32_t z, int levels) {
  // Skilling's algorithm: undo the excess work of each level, then Gray encode, then interleave the bits.
  std::array<std::uint32_t, 3> axes{x, y, z};
  const std::uint32_t top = std::uint32_t{1} << (levels - 1);
  for (std::uint32_t bit = top; bit > 1; bit >>= 1) {
    const std::uint32_t below = bit - 1;
    for (std::uint32_t& axis : axes) {
      if (axis & bit) {
        axes[0] ^= below;
      } else {
        const std::uint32_t swap = (axes[0] ^ axis) & below;
        axes[0] ^= swap;
        axis ^= swap;
      }
    }
  }
  axes[1] ^= axes[0];
  axes[2] ^= axes[1];
  std::uint32_t flip = 0;
  for (std::uint32_t bit = top; bit > 1; bit >>= 1) {
    if (axes[2] & bit) flip ^= bit - 1;
  }
  std::uint64_t index = 0;
  for (int level = levels - 1; level >= 0; --level) {
    for (const std::uint32_t axis : axes) index = (index << 1) | (((axis ^ flip) >> level) & 1U);
  }
  return index;
}

void HilbertOrder::compute(const PointView& points, float cell_size, std::vector<char>& scratch) {
  const std::size_t count = points.size();
  order_.resize(count);
  if (count == 0) return;
  scratch.resize(std::max(scratch.size(), count * (2 * sizeof(std::uint64_t) + sizeof(std::uint32_t))));
  auto* keys = reinterpret_cast<std::uint64_t*>(scratch.data());
  auto* sorted_keys = keys + count;
  auto* order = order_.data();
  auto* sorted_order = reinterpret_cast<std::uint32_t*>(sorted_keys + count);

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
    order[i] = static_cast<std::uint32_t>(i);
  }

  // Stable radix sort, eleven bits at a time.
  constexpr int digit_bits = 11;
  constexpr std::size_t buckets = std::size_t{1} << digit_bits;
  for (int shift = 0; shift < 3 * levels; shift += digit_bits) {
    std::array<std::uint32_t, buckets> start{};
    for (std::size_t i = 0; i < count; ++i) ++start[(keys[i] >> shift) & (buckets - 1)];
    std::uint32_t sum = 0;
    for (std::uint32_t& s : start) {
      const std::uint32_t in_bucket = s;
      s = sum;
      sum += in_bucket;
    }
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t place = start[(keys[i] >> shift) & (buckets - 1)]++;
      sorted_keys[place] = keys[i];
      sorted_order[place] = order[i];
    }
    std::swap(keys, sorted_keys);
    std::swap(order, sorted_order);
  }
  if (order != order_.data()) std::memcpy(order_.data(), order, count * sizeof(std::uint32_t));
}

std::size_t HilbertOrder::memory_bytes() const { return order_.capacity() * sizeof(std::uint32_t); }

}  // namespace flowskin::sph
