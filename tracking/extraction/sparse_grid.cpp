#include "tracking/extraction/sparse_grid.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace flowskin::tracking {
namespace {

constexpr double kShift = 0.37;
constexpr int kKeyBits = 21;
constexpr int kKeyOffset = 1 << (kKeyBits - 1);

// Keys ascend in lexicographic order of the places.
std::uint64_t key_of(const SparseGrid::Index& place) {
  std::uint64_t key = 0;
  for (int coordinate : place) key = key << kKeyBits | static_cast<std::uint64_t>(coordinate + kKeyOffset);
  return key;
}

SparseGrid::Index place_of(std::uint64_t key) {
  constexpr std::uint64_t mask = (std::uint64_t{1} << kKeyBits) - 1;
  SparseGrid::Index place{};
  for (int axis = 2; axis >= 0; --axis) {
    place[axis] = static_cast<int>(key & mask) - kKeyOffset;
    key >>= kKeyBits;
  }
  return place;
}

int block_coordinate(int node) { return node >= 0 ? node / SparseGrid::kSide : -((-node - 1) / SparseGrid::kSide) - 1; }

// A range of nodes along each axis, both ends included.
struct NodeBox {
  SparseGrid::Index low, high;
};

NodeBox support_box(const Vec3& x, double radius, double spacing) {
  NodeBox box{};
  for (int axis = 0; axis < 3; ++axis) {
    const double low = (x[axis] - radius) / spacing - kShift;
    const double high = (x[axis] + radius) / spacing - kShift;
    constexpr double limit = static_cast<double>(kKeyOffset - 2) * SparseGrid::kSide;
    if (!(low > -limit && high < limit)) {
      throw std::invalid_argument("surface extraction: a particle at coordinate " + std::to_string(x[axis]) +
                                  " m is not finite or too far away for a grid of spacing " + std::to_string(spacing) +
                                  " m; remove particles that left the scene");
    }
    box.low[axis] = static_cast<int>(std::ceil(low));
    box.high[axis] = static_cast<int>(std::floor(high));
  }
  return box;
}

// Calls visit(place) for every block that meets the box widened by `margin` nodes.
template <typename Visit>
void for_each_block(const NodeBox& box, int margin, const Visit& visit) {
  SparseGrid::Index low{}, high{};
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = block_coordinate(box.low[axis] - margin);
    high[axis] = block_coordinate(box.high[axis] + margin);
  }
  for (int i = low[0]; i <= high[0]; ++i) {
    for (int j = low[1]; j <= high[1]; ++j) {
      for (int k = low[2]; k <= high[2]; ++k) visit(SparseGrid::Index{i, j, k});
    }
  }
}

// Adds the kernel of one particle to the nodes of one block. `x` is relative to the block's first node, in spacings.
void add_kernel(const Vec3& x, double radius_in_spacings, double weight, SparseGrid::Block& block) {
  constexpr int side = SparseGrid::kSide;
  std::array<int, 3> low{}, high{};
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = std::max(0, static_cast<int>(std::ceil(x[axis] - radius_in_spacings)));
    high[axis] = std::min(side - 1, static_cast<int>(std::floor(x[axis] + radius_in_spacings)));
  }
  const double scale = 1 / (radius_in_spacings * radius_in_spacings);
  for (int i = low[0]; i <= high[0]; ++i) {
    for (int j = low[1]; j <= high[1]; ++j) {
      const double rest = 1 - scale * ((i - x[0]) * (i - x[0]) + (j - x[1]) * (j - x[1]));
      if (rest <= 0) continue;
      double* row = block.values.data() + SparseGrid::node_in_block(i, j, 0);
      for (int k = low[2]; k <= high[2]; ++k) {
        const double q = std::max(0.0, rest - scale * (k - x[2]) * (k - x[2]));
        row[k] += weight * q * q * q;
      }
    }
  }
}

}  // namespace

void SparseGrid::allocate(std::vector<std::uint64_t> keys) {
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
  const auto found = std::lower_bound(keys_.begin(), keys_.end(), key_of(place));
  return found != keys_.end() && *found == key_of(place) ? static_cast<int>(found - keys_.begin()) : -1;
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

SparseGrid SparseGrid::of_particles(const std::vector<Vec3>& positions, const FieldSettings& settings, double spacing,
                                    const std::vector<double>& shares) {
  const auto share = [&shares](std::size_t p) { return shares.empty() ? 1.0 : shares[p]; };
  if (!(spacing > 0 && settings.radius > 0 && settings.threshold > 0)) {
    throw std::invalid_argument("surface extraction: grid spacing (" + std::to_string(spacing) + " m), field radius (" +
                                std::to_string(settings.radius) + " m) and threshold (" +
                                std::to_string(settings.threshold) + ") must be positive");
  }
  SparseGrid grid(spacing, -settings.threshold);
  std::vector<NodeBox> boxes(positions.size());
  std::vector<std::uint64_t> keys;
  for (std::size_t p = 0; p < positions.size(); ++p) {
    if (!(share(p) > 0)) continue;
    boxes[p] = support_box(positions[p], settings.radius, spacing);
    for_each_block(boxes[p], 1, [&](const Index& place) {
      if (keys.empty() || keys.back() != key_of(place)) keys.push_back(key_of(place));
    });
    // Neighbouring particles name the same blocks: thin the list out before it grows large.
    if ((p & 1023) == 1023) {
      std::sort(keys.begin(), keys.end());
      keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    }
  }
  grid.allocate(std::move(keys));

  // Particles of each block, ascending, so that sums do not depend on the number of threads.
  std::vector<std::vector<int>> members(grid.blocks_.size());
  for (std::size_t p = 0; p < positions.size(); ++p) {
    if (!(share(p) > 0)) continue;
    for_each_block(boxes[p], 0, [&](const Index& place) { members[grid.find(place)].push_back(static_cast<int>(p)); });
  }
#pragma omp parallel for schedule(dynamic, 4)
  for (int b = 0; b < static_cast<int>(members.size()); ++b) {
    Block& block = grid.blocks_[b];
    const Vec3 first = grid.position({kSide * block.place[0], kSide * block.place[1], kSide * block.place[2]});
    for (int p : members[b]) {
      add_kernel((positions[p] - first) / spacing, settings.radius / spacing, share(p) * settings.weight, block);
    }
  }
  return grid;
}

SparseGrid SparseGrid::of_field(const MetaballField& field, double spacing) {
  SparseGrid grid = of_particles(field.positions(), field.settings(), spacing, field.shares());
  for (const auto& wall : field.walls()) grid.add_wall(*wall, field.settings());
  return grid;
}

// Only to blocks that particles have made: a bare wall has no surface.
void SparseGrid::add_wall(const FieldWall& wall, const FieldSettings& settings) {
#pragma omp parallel for schedule(dynamic, 4)
  for (int b = 0; b < static_cast<int>(blocks_.size()); ++b) {
    thread_local std::vector<Vec3> points;
    Block& block = blocks_[b];
    const Vec3 first = position({kSide * block.place[0], kSide * block.place[1], kSide * block.place[2]});
    wall.near(first, first + Vec3::Constant((kSide - 1) * spacing_), settings.radius, points);
    for (const Vec3& point : points) {
      add_kernel((point - first) / spacing_, settings.radius / spacing_, wall.share() * settings.weight, block);
    }
  }
}

SparseGrid SparseGrid::of_values(const Index& size, const std::vector<double>& values, double outside, double spacing) {
  if (values.size() != static_cast<std::size_t>(size[0]) * size[1] * size[2] || !(spacing > 0)) {
    throw std::invalid_argument("sparse grid: " + std::to_string(values.size()) + " values for " +
                                std::to_string(size[0]) + " x " + std::to_string(size[1]) + " x " +
                                std::to_string(size[2]) + " nodes of spacing " + std::to_string(spacing));
  }
  SparseGrid grid(spacing, outside);
  std::vector<std::uint64_t> keys;
  const NodeBox box{{0, 0, 0}, {size[0] - 1, size[1] - 1, size[2] - 1}};
  for_each_block(box, 1, [&](const Index& place) { keys.push_back(key_of(place)); });
  grid.allocate(std::move(keys));
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

}  // namespace flowskin::tracking
