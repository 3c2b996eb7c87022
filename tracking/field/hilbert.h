// Order of points along Hilbert's space-filling curve. Internal to tracking/field.
#pragma once

#include <cstdint>
#include <vector>

#include "tracking/particles.h"

namespace flowskin::tracking {

/// Index of a cell along the Hilbert curve through a cube of 2^bits cells a side (bits at most 21)
/// [J. Skilling, Programming the Hilbert curve, AIP Conf. Proc. 707, 2004].
std::uint64_t hilbert_index(std::uint32_t x, std::uint32_t y, std::uint32_t z, int bits);

/// The points' indices in the order of the Hilbert curve through cells of edge `cell` (m; coarser where the points
/// spread over more than 2^21 of them); points of one cell in ascending order. Points must be finite.
std::vector<int> hilbert_order(const std::vector<Vec3>& points, double cell);

}  // namespace flowskin::tracking
