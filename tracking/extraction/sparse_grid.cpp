#include "tracking/extraction/sparse_grid.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "common/number_text.h"

namespace flowskin::tracking {
namespace {

constexpr double kShift = 0.37;
constexpr int kKeyBits = 21;
constexpr int kKeyOffset = 1 << (kKeyBits - 1);

SparseGrid::Index place_of(std::uint64_t key) {
  constexpr std::uint64_t mask = (std::uint64_t{1} << kKeyBits) - 1;
  SparseGrid::Index place{};
  for (int axis = 2; axis >= 0; --axis) {
    place[axis] = static_cast<int>(key & mask) - kKeyOffset;
    key >>= kKeyBits;
  }
  return place;
}

}  // namespace

std::uint64_t SparseGrid::key(const Index& place) {
  std::uint64_t key = 0;
  for (int coordinate : place) key = key << kKeyBits | static_cast<std::uint64_t>(coordinate + kKeyOffset);
  return key;
}

int SparseGrid::block_coordinate(int node) { return node >= 0 ? node / kSide : -((-node - 1) / kSide) - 1; }

SparseGrid::NodeBox SparseGrid::nodes_within(const Vec3& low, const Vec3& high, double spacing) {
  NodeBox box{};
  for (int axis = 0; axis < 3; ++axis) {
    const double first = low[axis] / spacing - kShift, last = high[axis] / spacing - kShift;
    constexpr double limit = static_cast<double>(kKeyOffset - 2) * kSide;
    if (!(first > -limit && last < limit)) {
      throw std::invalid_argument("surface extraction: the range from " + number_text(low[axis], 4) + " m to " +
                                  number_text(high[axis], 4) +
                                  " m is not finite or too far away for a grid of spacing " + number_text(spacing, 4) +
                                  " m; remove particles that left the scene, or "
                                  "move all nearer to the origin");
    }
    box.low[axis] = static_cast<int>(std::ceil(first));
    box.high[axis] = static_cast<int>(std::floor(last));
  }
  return box;
}

SparseGrid::SparseGrid(double spacing, double outside, std::vector<std::uint64_t> keys)
    : spacing_(spacing), outside_(outside) {
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  keys_ = std::move(keys);
  blocks_.resize(keys_.size());
  for (std::size_t b = 0; b < keys_.size(); ++b) {
    blocks_[b].place = place_of(keys_[b]);
    blocks_[b].values.fill(outside_);
  }
}

int SparseGrid::find(const Index& place) const {
  const auto found = std::lower_bound(keys_.begin(), keys_.end(), key(place));
  return found != keys_.end() && *found == key(place) ? static_cast<int>(found - keys_.begin()) : -1;
}

Vec3 SparseGrid::position(const Index& node) const {
  return spacing_ * Vec3(node[0] + kShift, node[1] + kShift, node[2] + kShift);
}

Vec3 SparseGrid::coordinates(const Vec3& x) const { return x / spacing_ - Vec3::Constant(kShift); }

double SparseGrid::value(const Index& node) const {
  Index place{}, inner{};
  for (int axis = 0; axis < 3; ++axis) {
    place[axis] = block_coordinate(node[axis]);
    inner[axis] = node[axis] - kSide * place[axis];
  }
  const int block = find(place);
  return block < 0 ? outside_ : blocks_[block].values[node_in_block(inner[0], inner[1], inner[2])];
}

std::array<double, 8> SparseGrid::corner_values(const Index& cell) const {
  std::array<double, 8> values{};
  Index place{}, inner{};
  bool in_one_block = true;
  for (int axis = 0; axis < 3; ++axis) {
    place[axis] = block_coordinate(cell[axis]);
    inner[axis] = cell[axis] - kSide * place[axis];
    in_one_block = in_one_block && inner[axis] + 1 < kSide;
  }
  const int block = in_one_block ? find(place) : -1;
  for (int c = 0; c < 8; ++c) {
    const Index corner = {c & 1, c >> 1 & 1, c >> 2};
    if (!in_one_block) {
      values[c] = value({cell[0] + corner[0], cell[1] + corner[1], cell[2] + corner[2]});
    } else {
      const int node = node_in_block(inner[0] + corner[0], inner[1] + corner[1], inner[2] + corner[2]);
      values[c] = block < 0 ? outside_ : blocks_[block].values[node];
    }
  }
  return values;
}

SparseGrid SparseGrid::of_values(const Index& size, const std::vector<double>& values, double outside, double spacing) {
  if (values.size() != static_cast<std::size_t>(size[0]) * size[1] * size[2] || !(spacing > 0)) {
    throw std::invalid_argument("sparse grid: " + std::to_string(values.size()) + " values for " +
                                std::to_string(size[0]) + " x " + std::to_string(size[1]) + " x " +
                                std::to_string(size[2]) + " nodes of spacing " + number_text(spacing, 4));
  }
  std::vector<std::uint64_t> keys;
  const NodeBox box{{0, 0, 0}, {size[0] - 1, size[1] - 1, size[2] - 1}};
  for_each_block(box, 1, [&](const Index& place) { keys.push_back(key(place)); });
  SparseGrid grid(spacing, outside, std::move(keys));
  std::size_t next = 0;
  for (int i = 0; i < size[0]; ++i) {
    for (int j = 0; j < size[1]; ++j) {
      for (int k = 0; k < size[2]; ++k) {
        Block& block = grid.blocks_[grid.find({i / kSide, j / kSide, k / kSide})];
        block.values[node_in_block(i % kSide, j % kSide, k % kSide)] = values[next++];
      }
    }
  }
  return grid;
}

SparseGrid SparseGrid::of_function(const std::function<double(const Vec3&)>& value, const Box& box, double outside,
                                   double spacing) {
  if (!(spacing > 0)) {
    throw std::invalid_argument("surface extraction: the grid's spacing is " + number_text(spacing, 4) +
                                ", but must be positive (m)");
  }
  std::vector<std::uint64_t> keys;
  for_each_block(nodes_within(box.min, box.max, spacing), 1, [&](const Index& place) { keys.push_back(key(place)); });
  SparseGrid grid(spacing, outside, std::move(keys));
#pragma omp parallel for schedule(dynamic, 4)
  for (std::ptrdiff_t b = 0; b < std::ssize(grid.blocks_); ++b) {
    Block& block = grid.blocks_[b];
    for (int n = 0; n < kNodes; ++n) {
      const Vec3 x = grid.position({kSide * block.place[0] + n / (kSide * kSide),
                                    kSide * block.place[1] + n / kSide % kSide, kSide * block.place[2] + n % kSide});
      if (box.squared_distance(x) == 0) block.values[n] = value(x);
    }
  }
  return grid;
}

}  // namespace flowskin::tracking
