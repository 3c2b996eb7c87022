#include "common/hilbert.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace flowskin {
namespace {

/// Moves bit i to bit 3i.
std::uint64_t spread_bits(std::uint64_t x) {
  x = (x | x << 32U) & 0x001f00000000ffffULL;
  x = (x | x << 16U) & 0x001f0000ff0000ffULL;
  x = (x | x << 8U) & 0x100f00f00f00f00fULL;
  x = (x | x << 4U) & 0x10c30c30c30c30c3ULL;
  return (x | x << 2U) & 0x1249249249249249ULL;
}

}  // namespace

std::uint64_t hilbert_index(std::uint32_t x, std::uint32_t y, std::uint32_t z, int bits) {
  std::array<std::uint32_t, 3> axes = {x, y, z};
  const std::uint32_t top = 1U << static_cast<unsigned>(bits - 1);
  for (std::uint32_t bit = top; bit > 1; bit >>= 1U) {  // undo the turns of each level
    const std::uint32_t below = bit - 1;
    for (std::uint32_t& axis : axes) {
      if ((axis & bit) != 0) {
        axes[0] ^= below;
      } else {
        const std::uint32_t swapped = (axes[0] ^ axis) & below;
        axes[0] ^= swapped;
        axis ^= swapped;
      }
    }
  }
  axes[1] ^= axes[0];  // Gray code
  axes[2] ^= axes[1];
  std::uint32_t flip = 0;
  for (std::uint32_t bit = top; bit > 1; bit >>= 1U) {
    if ((axes[2] & bit) != 0) flip ^= bit - 1;
  }
  return spread_bits(axes[0] ^ flip) << 2U | spread_bits(axes[1] ^ flip) << 1U | spread_bits(axes[2] ^ flip);
}

std::vector<int> hilbert_order(const std::vector<Vec3>& points, double cell) {
  if (points.empty()) return {};
  Vec3 low = points.front();
  Vec3 high = points.front();
  for (const Vec3& point : points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  const double extent = (high - low).maxCoeff();
  int bits = 1;
  while (bits < kMostHilbertBits && std::ldexp(cell, bits) <= extent) ++bits;
  const double last_cell = std::ldexp(1.0, bits) - 1;
  const double cells_per_metre = extent > 0 ? std::min(1 / cell, last_cell / extent) : 0;

  const auto count = static_cast<std::ptrdiff_t>(points.size());
  std::vector<std::uint64_t> keys(points.size()), spare_keys(points.size());
  std::vector<int> order(points.size()), spare_order(points.size());
#pragma omp parallel for schedule(static) if (count > 10000)
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const Vec3 at = ((points[i] - low) * cells_per_metre).cwiseMin(last_cell);
    keys[i] = hilbert_index(static_cast<std::uint32_t>(at.x()), static_cast<std::uint32_t>(at.y()),
                            static_cast<std::uint32_t>(at.z()), bits);
    order[i] = static_cast<int>(i);
  }
  sort_by_key(keys.data(), order.data(), points.size(), 3 * bits, spare_keys.data(), spare_order.data());
  return order;
}

}  // namespace flowskin
