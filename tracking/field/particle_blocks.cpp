#include "tracking/field/particle_blocks.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <nanoflann.hpp>

#include "tracking/field/hilbert.h"

namespace flowskin::tracking {
namespace {

// Chosen with tests/benchmarks/tracking_benchmark.cpp.
constexpr int largest_count = 64;        // particles in a block
constexpr double largest_size = 1.2;     // half the diagonal of a block's box, in reaches
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
  std::vector<Vec3> centres;
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
    add_block(positions, velocities, order.data() + begin, order.data() + end);
    centres.emplace_back(0.5 * (low + high));
    largest_block_ = std::max(largest_block_, 0.5 * (high - low).norm());
  }
  if (!centres.empty()) tree_ = std::make_unique<Tree>(std::move(centres));
}

ParticleBlocks::~ParticleBlocks() = default;
ParticleBlocks::ParticleBlocks(ParticleBlocks&&) noexcept = default;

void ParticleBlocks::add_block(const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities,
                               const int* begin, const int* end) {
  constexpr double nowhere = std::numeric_limits<double>::infinity();
  const Lanes far_away = {nowhere, nowhere, nowhere, nowhere};
  const int first_boxes = static_cast<int>(boxes_.size());
  for (const int* at = begin; at < end;) {
    GroupBoxes boxes{far_away, far_away, far_away, far_away, far_away, far_away};
    for (int box = 0; box < lane_count; ++box) {
      ParticleGroup group{far_away, far_away, far_away, Lanes{}, Lanes{}, Lanes{}};
      Vec3 low = Vec3::Constant(nowhere);
      Vec3 high = Vec3::Constant(at < end ? -nowhere : nowhere);
      for (int lane = 0; lane < lane_count; ++lane) {
        const int particle = at < end ? *at++ : -1;
        particles_.push_back(particle);
        if (particle < 0) continue;
        const Vec3& position = positions[particle];
        low = low.cwiseMin(position);
        high = high.cwiseMax(position);
        group.x[lane] = position.x();
        group.y[lane] = position.y();
        group.z[lane] = position.z();
        if (velocities.empty()) continue;
        group.vx[lane] = velocities[particle].x();
        group.vy[lane] = velocities[particle].y();
        group.vz[lane] = velocities[particle].z();
      }
      groups_.push_back(group);
      boxes.low_x[box] = low.x();
      boxes.low_y[box] = low.y();
      boxes.low_z[box] = low.z();
      boxes.high_x[box] = high.x();
      boxes.high_y[box] = high.y();
      boxes.high_z[box] = high.z();
    }
    boxes_.push_back(boxes);
  }
  blocks_.push_back({first_boxes, static_cast<int>(boxes_.size())});
}

int ParticleBlocks::near(const Vec3& x, double radius, std::vector<int>& found) const {
  if (!tree_ || !x.allFinite()) return 0;
  // A particle on the rim of the reach must not be lost to rounding in the tree: look a little further.
  constexpr double margin = 1 + 1e-9;
  thread_local std::vector<int> near_blocks;
  near_blocks.clear();
  BlocksWithin within(square((radius + largest_block_) * margin), near_blocks);
  tree_->index.findNeighbors(within, x.data(), {});
  std::sort(near_blocks.begin(), near_blocks.end());

  const std::size_t most = near_blocks.size() * largest_count / lane_count;
  if (found.size() < most) found.resize(most);
  const double limit = square(radius * margin);
  const auto add_square_beyond = [](const Lanes& low, const Lanes& high, double at, Lanes& sum) {
    const Lanes below = low - at;
    const Lanes above = at - high;
    const Lanes outside = below > above ? below : above;  // of the interval; negative inside
    sum += outside > 0 ? outside * outside : Lanes{};
  };
  int count = 0;
  for (const int index : near_blocks) {
    const Block& block = blocks_[index];
    for (int b = block.first_boxes; b < block.last_boxes; ++b) {
      const GroupBoxes& boxes = boxes_[b];
      Lanes distance_squared{};
      add_square_beyond(boxes.low_x, boxes.high_x, x.x(), distance_squared);
      add_square_beyond(boxes.low_y, boxes.high_y, x.y(), distance_squared);
      add_square_beyond(boxes.low_z, boxes.high_z, x.z(), distance_squared);
      const LaneMask reached = distance_squared <= limit;
      for (int lane = 0; lane < lane_count; ++lane) {  // without branches: which ones are near cannot be foretold
        found[count] = b * lane_count + lane;
        count -= static_cast<int>(reached[lane]);
      }
    }
  }
  return count;
}

}  // namespace flowskin::tracking
