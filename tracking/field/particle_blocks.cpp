#include "tracking/field/particle_blocks.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <nanoflann.hpp>

#include "tracking/field/hilbert.h"

namespace flowskin::tracking {
namespace {

constexpr int largest_count = 16;        // particles in a block
constexpr double largest_size = 0.5;     // half the diagonal of a block's box, in reaches
constexpr double cell_in_reaches = 0.2;  // finer cells would not change the order by much
constexpr int tree_leaf_size = 8;

double square(double a) { return a * a; }

/// nanoflann's view of the block centres.
struct BlockCentres {
  std::vector<Vec3> points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const { return points[i][static_cast<Eigen::Index>(axis)]; }
  template <class Box>
  bool kdtree_get_bbox(Box& /*box*/) const {
    return false;
  }
};

using BlockTree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, BlockCentres>, BlockCentres, 3, int>;

/// nanoflann's result set: collects block numbers within a radius, without distances and without sorting.
class BlocksWithin {
 public:
  BlocksWithin(double radius_squared, std::vector<int>& found) : radius_squared_(radius_squared), found_(found) {}
  std::size_t size() const { return found_.size(); }
  static bool full() { return true; }
  bool addPoint(double distance_squared, int block) {
    if (distance_squared < radius_squared_) found_.push_back(block);
    return true;
  }
  double worstDist() const { return radius_squared_; }

 private:
  double radius_squared_;
  std::vector<int>& found_;
};

}  // namespace

struct ParticleBlocks::Tree {
  explicit Tree(std::vector<Vec3> centres)
      : points{std::move(centres)}, index(3, points, nanoflann::KDTreeSingleIndexAdaptorParams(tree_leaf_size)) {
    index.buildIndex();
  }
  BlockCentres points;
  BlockTree index;
};

ParticleBlocks::ParticleBlocks(const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities, double reach) {
  const std::vector<int> order = hilbert_order(positions, cell_in_reaches * reach);
  const double diagonal_limit = square(2 * largest_size * reach);
  const int count = static_cast<int>(order.size());
  for (int begin = 0, end = 0; begin < count; begin = end) {
    Vec3 low = positions[order[begin]];
    Vec3 high = low;
    for (end = begin + 1; end < count && end - begin < largest_count; ++end) {
      const Vec3& next = positions[order[end]];
      const Vec3 new_low = low.cwiseMin(next);
      const Vec3 new_high = high.cwiseMax(next);
      if ((new_high - new_low).squaredNorm() > diagonal_limit) break;
      low = new_low;
      high = new_high;
    }
    add_block(positions, velocities, &order[begin], &order[begin] + (end - begin));
    blocks_.back().low = low;
    blocks_.back().high = high;
    largest_block_ = std::max(largest_block_, 0.5 * (high - low).norm());
  }
  std::vector<Vec3> centres;
  centres.reserve(blocks_.size());
  for (const ParticleBlock& block : blocks_) centres.emplace_back(0.5 * (block.low + block.high));
  if (!centres.empty()) tree_ = std::make_unique<Tree>(std::move(centres));
}

ParticleBlocks::~ParticleBlocks() = default;

void ParticleBlocks::add_block(const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities,
                               const int* begin, const int* end) {
  const int first_group = static_cast<int>(groups_.size());
  for (const int* at = begin; at < end; at += lane_count) {
    constexpr double nowhere = std::numeric_limits<double>::infinity();
    ParticleGroup group{};
    for (int lane = 0; lane < lane_count; ++lane) {
      const bool filled = at + lane < end;
      const int particle = filled ? at[lane] : -1;
      particles_.push_back(particle);
      const Vec3 position = filled ? positions[particle] : Vec3::Constant(nowhere);
      const Vec3 velocity = filled && !velocities.empty() ? velocities[particle] : Vec3(Vec3::Zero());
      group.x[lane] = position.x();
      group.y[lane] = position.y();
      group.z[lane] = position.z();
      group.vx[lane] = velocity.x();
      group.vy[lane] = velocity.y();
      group.vz[lane] = velocity.z();
    }
    groups_.push_back(group);
  }
  blocks_.push_back({Vec3::Zero(), Vec3::Zero(), first_group, static_cast<int>(groups_.size())});
}

void ParticleBlocks::near(const Vec3& x, double radius, std::vector<int>& found) const {
  found.clear();
  if (!tree_ || !x.allFinite()) return;
  // A particle on the rim of the reach must not be lost to rounding in the tree: look a little further.
  constexpr double margin = 1 + 1e-9;
  BlocksWithin within(square((radius + largest_block_) * margin), found);
  tree_->index.findNeighbors(within, x.data(), {});
  const double limit = square(radius * margin);
  std::erase_if(found, [&](int index) {
    const ParticleBlock& block = blocks_[index];
    return (block.low - x).cwiseMax(x - block.high).cwiseMax(0.0).squaredNorm() > limit;
  });
  std::sort(found.begin(), found.end());
}

}  // namespace flowskin::tracking
