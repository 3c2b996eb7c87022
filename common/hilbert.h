// Order of points along Hilbert's space-filling curve: points that follow each other are close in space and in memory.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "common/vectors.h"

namespace flowskin {

/// Along each edge the curve passes through at most 2^kMostHilbertBits cells: three times as many bits fit in 64.
inline constexpr int kMostHilbertBits = 21;

/// Index of a cell along the Hilbert curve through a cube of 2^bits cells per side (bits from 1 to kMostHilbertBits)
/// [J. Skilling, Programming the Hilbert curve, AIP Conf. Proc. 707, 2004].
std::uint64_t hilbert_index(std::uint32_t x, std::uint32_t y, std::uint32_t z, int bits);

/// Sorts keys of up to `bits` bits and the values beside them, equal keys staying in their order: digit by digit from
/// the lowest (radix sort), which for the few digits of Hilbert indices is several times as fast as by comparisons.
/// @param spare_keys, spare_values room for as many; what is left in them has no meaning
template <class Value>
void sort_by_key(std::uint64_t* keys, Value* values, std::size_t count, int bits, std::uint64_t* spare_keys,
                 Value* spare_values) {
  constexpr int digit_bits = 11;
  constexpr std::size_t digits = std::size_t{1} << digit_bits;
  std::uint64_t* const sorted = keys;
  Value* const sorted_values = values;
  for (int shift = 0; shift < bits; shift += digit_bits) {
    std::array<std::size_t, digits> place{};
    for (std::size_t i = 0; i < count; ++i) ++place[(keys[i] >> shift) & (digits - 1)];
    std::size_t sum = 0;
    for (std::size_t& p : place) sum += std::exchange(p, sum);
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t k = place[(keys[i] >> shift) & (digits - 1)]++;
      spare_keys[k] = keys[i];
      spare_values[k] = values[i];
    }
    std::swap(keys, spare_keys);
    std::swap(values, spare_values);
  }
  if (keys == sorted) return;
  for (std::size_t i = 0; i < count; ++i) {
    sorted[i] = keys[i];
    sorted_values[i] = values[i];
  }
}

/// The points' indices in the order of the Hilbert curve through cells of edge `cell` (m; coarser where the points
/// spread over more than 2^21 of them); points of one cell in ascending order. Points must be finite.
std::vector<int> hilbert_order(const std::vector<Vec3>& points, double cell);

}  // namespace flowskin
