#include "tracking/field/metaballs/metaball_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "common/number_text.h"
#include "tracking/field/metaballs/field_parts.h"

namespace flowskin::tracking {
namespace {

// Adds the kernel of one particle to the nodes of one block. `x` is relative to the block's first node, in spacings.
void add_kernel(const Vec3& x, double radius_in_spacings, double weight, SparseGrid::Block& block) {
  constexpr int side = SparseGrid::kSide;
  std::array<int, 2> low{}, high{};
  for (int axis = 0; axis < 2; ++axis) {
    low[axis] = std::max(0, static_cast<int>(std::ceil(x[axis] - radius_in_spacings)));
    high[axis] = std::min(side - 1, static_cast<int>(std::floor(x[axis] + radius_in_spacings)));
  }
  const double scale = 1 / (radius_in_spacings * radius_in_spacings);
  for (int i = low[0]; i <= high[0]; ++i) {
    for (int j = low[1]; j <= high[1]; ++j) {
      const double rest = 1 - scale * ((i - x[0]) * (i - x[0]) + (j - x[1]) * (j - x[1]));
      if (rest <= 0) continue;
      double* row = block.values.data() + SparseGrid::node_in_block(i, j, 0);
      // The whole row, without a branch: what is out of reach gets nothing.
      for (int k = 0; k < side; ++k) {
        const double q = std::max(0.0, rest - scale * (k - x[2]) * (k - x[2]));
        row[k] += weight * q * q * q;
      }
    }
  }
}

// The blocks that particles name; neighbours name the same ones, so most names are known by a look at one place.
class BlockKeys {
 public:
  void add(std::uint64_t key) {
    std::uint64_t& seen = seen_[(key * 0x9E3779B97F4A7C15U) >> (64 - kBits)];
    // No block has the key 0xFF...: it stands for none.
    if (seen == key) return;
    seen = key;
    keys_.push_back(key);
  }
  std::vector<std::uint64_t> take() && { return std::move(keys_); }

 private:
  static constexpr int kBits = 12;
  std::vector<std::uint64_t> seen_ = std::vector<std::uint64_t>(std::size_t{1} << kBits, ~std::uint64_t{0});
  std::vector<std::uint64_t> keys_;
};

Vec3 first_node(const SparseGrid& grid, const SparseGrid::Block& block) {
  constexpr int side = SparseGrid::kSide;
  return grid.position({side * block.place[0], side * block.place[1], side * block.place[2]});
}

// Only to blocks that particles have made: a bare wall has no surface.
void add_wall(const FieldWall& wall, const FieldSettings& settings, SparseGrid& grid) {
  const double spacing = grid.spacing();
#pragma omp parallel for schedule(dynamic, 4)
  for (int b = 0; b < static_cast<int>(grid.blocks().size()); ++b) {
    thread_local std::vector<Vec3> points;
    SparseGrid::Block& block = grid.blocks()[b];
    const Vec3 first = first_node(grid, block);
    wall.near(first, first + Vec3::Constant((SparseGrid::kSide - 1) * spacing), settings.radius, points);
    for (const Vec3& point : points) {
      add_kernel((point - first) / spacing, settings.radius / spacing, wall.share() * settings.weight, block);
    }
  }
}

}  // namespace

SparseGrid grid_of_particles(const std::vector<Vec3>& positions, const FieldSettings& settings, double spacing,
                             const std::vector<double>& shares) {
  const auto share = [&shares](std::size_t p) { return shares.empty() ? 1.0 : shares[p]; };
  if (!(spacing > 0 && settings.radius > 0 && settings.threshold > 0)) {
    throw std::invalid_argument("surface extraction: grid spacing (" + number_text(spacing, 4) + " m), field radius (" +
                                number_text(settings.radius, 4) + " m) and threshold (" +
                                number_text(settings.threshold, 4) + ") must be positive");
  }
  std::vector<SparseGrid::NodeBox> boxes(positions.size());
  const Vec3 reach = Vec3::Constant(settings.radius);
  BlockKeys keys;
  for (std::size_t p = 0; p < positions.size(); ++p) {
    if (!(share(p) > 0)) continue;
    boxes[p] = SparseGrid::nodes_within(positions[p] - reach, positions[p] + reach, spacing);
    SparseGrid::for_each_block(boxes[p], 1, [&](const SparseGrid::Index& place) { keys.add(SparseGrid::key(place)); });
  }
  SparseGrid grid(spacing, -settings.threshold, std::move(keys).take());

  // Particles of each block, ascending, so that sums do not depend on the number of threads.
  std::vector<std::vector<int>> members(grid.blocks().size());
  for (std::size_t p = 0; p < positions.size(); ++p) {
    if (!(share(p) > 0)) continue;
    SparseGrid::for_each_block(
        boxes[p], 0, [&](const SparseGrid::Index& place) { members[grid.find(place)].push_back(static_cast<int>(p)); });
  }
#pragma omp parallel for schedule(dynamic, 4)
  for (int b = 0; b < static_cast<int>(members.size()); ++b) {
    SparseGrid::Block& block = grid.blocks()[b];
    const Vec3 first = first_node(grid, block);
    for (int p : members[b]) {
      add_kernel((positions[p] - first) / spacing, settings.radius / spacing, share(p) * settings.weight, block);
    }
  }
  return grid;
}

std::shared_ptr<const SparseGrid> MetaballField::on_grid(double spacing) const {
  const std::lock_guard guard(impl_->grid_lock);
  if (impl_->grid && impl_->grid->spacing() == spacing) return impl_->grid;
  SparseGrid grid = grid_of_particles(positions(), settings(), spacing, shares());
  for (const auto& wall : walls()) add_wall(*wall, settings(), grid);
  return impl_->grid = std::make_shared<const SparseGrid>(std::move(grid));
}

}  // namespace flowskin::tracking
