#include "tracking/repair/triangle_bins.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace flowskin::tracking {
namespace {

template <class Visit>
void for_each_bin(const Box& box, const Visit& visit) {
  std::array<std::int64_t, 3> first{}, last{};
  for (int axis = 0; axis < 3; ++axis) {
    first[axis] = static_cast<std::int64_t>(std::floor(box.min[axis] / TriangleBins::kSide));
    last[axis] = static_cast<std::int64_t>(std::floor(box.max[axis] / TriangleBins::kSide));
  }
  // 21 bits per axis: grids are smaller than that.
  constexpr int bits = 21;
  constexpr std::int64_t mask = (std::int64_t{1} << bits) - 1;
  for (std::int64_t i = first[0]; i <= last[0]; ++i) {
    for (std::int64_t j = first[1]; j <= last[1]; ++j) {
      for (std::int64_t k = first[2]; k <= last[2]; ++k)
        visit(static_cast<std::uint64_t>((i & mask) << (2 * bits) | (j & mask) << bits | (k & mask)));
    }
  }
}

}  // namespace

void TriangleBins::add(int triangle, const Box& box) {
  for_each_bin(box, [&](std::uint64_t bin) { bins_[bin].push_back(triangle); });
}

std::vector<int> TriangleBins::near(const Box& box) const {
  std::vector<int> found;
  for_each_bin(box, [&](std::uint64_t bin) {
    const auto triangles = bins_.find(bin);
    if (triangles != bins_.end()) found.insert(found.end(), triangles->second.begin(), triangles->second.end());
  });
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace flowskin::tracking
