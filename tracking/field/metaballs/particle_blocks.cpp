#include "tracking/field/metaballs/particle_blocks.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <nanoflann.hpp>
#include <utility>

#include "common/hilbert.h"

namespace flowskin::tracking {
namespace {

// Chosen with tests/benchmarks/tracking_benchmark.cpp.
constexpr int largest_count = 64;        // particles in a block
constexpr double largest_size = 1.2;     // half the diagonal of a block's box, in reaches
constexpr double cell_in_reaches = 0.2;  // finer cells would not change the order by much
constexpr int tree_leaf_size = 8;

// A query looks a little further, so that a particle on the rim of its reach is not lost to rounding.
constexpr double kBoxMargin = 1 + 1e-9;
// Where lanes without a particle lie: the square is finite, and nothing is near.
constexpr double far_away = 1e150;

double square(double a) { return a * a; }

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

/// Adds the squared distance along one axis from a range of points to four intervals.
void add_square_beyond(const Lanes& low, const Lanes& high, double first, double last, Lanes& sum) {
  const Lanes below = low - last;
  const Lanes above = first - high;
  const Lanes outside = below > above ? below : above;  // of the interval; negative inside
  sum += outside > 0 ? outside * outside : Lanes{};
}

/// Whether boxes are within a distance, whose square is `limit`, of the box from `low` to `high`.
LaneMask within(const GroupBoxes& boxes, const Vec3& low, const Vec3& high, double limit) {
  Lanes distance_squared{};
  add_square_beyond(boxes.low_x, boxes.high_x, low.x(), high.x(), distance_squared);
  add_square_beyond(boxes.low_y, boxes.high_y, low.y(), high.y(), distance_squared);
  add_square_beyond(boxes.low_z, boxes.high_z, low.z(), high.z(), distance_squared);
  return distance_squared <= limit;
}

/// Writes the indices of the groups near x among the four of these boxes; returns how many. There must be room for
/// four.
int write_near(const GroupBoxes& boxes, int index, const Vec3& x, double limit, int* found) {
  const LaneMask reached = within(boxes, x, x, limit);
  int count = 0;
  for (int lane = 0; lane < lane_count; ++lane) {  // without branches: which ones are near cannot be foretold
    found[count] = index * lane_count + lane;
    count -= static_cast<int>(reached[lane]);
  }
  return count;
}

}  // namespace

struct ParticleBlocks::Tree {
  /// nanoflann's view of the block centres.
  struct Centres {
    std::vector<Vec3> points;
    std::size_t kdtree_get_point_count() const { return points.size(); }
    double kdtree_get_pt(std::size_t i, std::size_t axis) const { return points[i][static_cast<Eigen::Index>(axis)]; }
    template <class Box>
    bool kdtree_get_bbox(Box& /*box*/) const {
      return false;
    }
  };

  using Index = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Centres>, Centres, 3, int>;

  explicit Tree(std::vector<Vec3> centres)
      : points{std::move(centres)}, index(3, points, nanoflann::KDTreeSingleIndexAdaptorParams(tree_leaf_size)) {
    index.buildIndex();
  }
  Centres points;
  Index index;
};

ParticleBlocks::ParticleBlocks(const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities, double reach) {
  const std::vector<int> order = hilbert_order(positions, cell_in_reaches * reach);
  const double diagonal_limit = square(2 * largest_size * reach);
  const int count = static_cast<int>(order.size());
  std::vector<Vec3> centres;
  std::vector<int> begins;  // of the blocks in the order
  for (int begin = 0, end = 0, boxes = 0; begin < count; begin = end) {
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
    constexpr int in_boxes = lane_count * lane_count;  // particles in four boxes
    const int first_boxes = std::exchange(boxes, boxes + (end - begin + in_boxes - 1) / in_boxes);
    blocks_.push_back({first_boxes, boxes});
    begins.push_back(begin);
    centres.emplace_back(0.5 * (low + high));
    largest_block_ = std::max(largest_block_, 0.5 * (high - low).norm());
  }
  if (centres.empty()) return;
  begins.push_back(count);
  tree_ = std::make_unique<Tree>(std::move(centres));

  const auto box_count = static_cast<std::size_t>(blocks_.back().last_boxes);
  boxes_.resize(box_count);
  positions_.resize(lane_count * box_count);
  velocities_.resize(velocities.empty() ? 0 : positions_.size());
  particles_.resize(lane_count * positions_.size());
#pragma omp parallel for schedule(static) if (count > 10000)
  for (int b = 0; b < static_cast<int>(blocks_.size()); ++b) {
    fill_block(blocks_[b], positions, velocities, order.data() + begins[b], order.data() + begins[b + 1]);
  }
}

ParticleBlocks::~ParticleBlocks() = default;
ParticleBlocks::ParticleBlocks(ParticleBlocks&&) noexcept = default;

void ParticleBlocks::fill_block(const Block& block, const std::vector<Vec3>& positions,
                                const std::vector<Vec3>& velocities, const int* begin, const int* end) {
  constexpr double nowhere = std::numeric_limits<double>::infinity();
  const Lanes no_box = {nowhere, nowhere, nowhere, nowhere};
  const Lanes no_place = {far_away, far_away, far_away, far_away};
  const auto set = [](GroupVectors& vectors, int lane, const Vec3& v) {
    vectors.x[lane] = v.x();
    vectors.y[lane] = v.y();
    vectors.z[lane] = v.z();
  };
  const int* at = begin;
  for (int b = block.first_boxes; b < block.last_boxes; ++b) {
    GroupBoxes boxes{no_box, no_box, no_box, no_box, no_box, no_box};
    for (int box = 0; box < lane_count; ++box) {
      const int group = b * lane_count + box;
      GroupVectors places{no_place, no_place, no_place}, speeds{};
      Vec3 low = Vec3::Constant(nowhere);
      Vec3 high = Vec3::Constant(at < end ? -nowhere : nowhere);
      for (int lane = 0; lane < lane_count; ++lane) {
        const int particle = at < end ? *at++ : -1;
        particles_[group * lane_count + lane] = particle;
        if (particle < 0) continue;
        low = low.cwiseMin(positions[particle]);
        high = high.cwiseMax(positions[particle]);
        set(places, lane, positions[particle]);
        if (!velocities.empty()) set(speeds, lane, velocities[particle]);
      }
      positions_[group] = places;
      if (!velocities.empty()) velocities_[group] = speeds;
      boxes.low_x[box] = low.x();
      boxes.low_y[box] = low.y();
      boxes.low_z[box] = low.z();
      boxes.high_x[box] = high.x();
      boxes.high_y[box] = high.y();
      boxes.high_z[box] = high.z();
    }
    boxes_[b] = boxes;
  }
}

void ParticleBlocks::blocks_near(const Vec3& x, double radius, std::vector<int>& found) const {
  found.clear();
  if (!tree_ || !x.allFinite()) return;
  BlocksWithin blocks(square((radius + largest_block_) * kBoxMargin), found);
  tree_->index.findNeighbors(blocks, x.data(), {});
  std::sort(found.begin(), found.end());
}

GroupList ParticleBlocks::near(const Vec3& x, double radius, std::vector<int>& found) const {
  thread_local std::vector<int> near_blocks;
  blocks_near(x, radius, near_blocks);
  const std::size_t most = near_blocks.size() * largest_count / lane_count;
  if (found.size() < most) found.resize(most);
  const double limit = square(radius * kBoxMargin);
  int count = 0;
  for (const int index : near_blocks) {
    const Block& block = blocks_[index];
    for (int b = block.first_boxes; b < block.last_boxes; ++b)
      count += write_near(boxes_[b], b, x, limit, found.data() + count);
  }
  return {found.data(), static_cast<std::size_t>(count)};
}

void ParticleBlocks::boxes_near(const Vec3& low, const Vec3& high, double radius, std::vector<int>& found) const {
  thread_local std::vector<int> near_blocks;
  blocks_near(0.5 * (low + high), radius + 0.5 * (high - low).norm(), near_blocks);
  const double limit = square(radius * kBoxMargin);
  found.clear();
  for (const int index : near_blocks) {
    const Block& block = blocks_[index];
    for (int b = block.first_boxes; b < block.last_boxes; ++b) {
      if (any_lane(within(boxes_[b], low, high, limit))) found.push_back(b);
    }
  }
}

void ParticleBlocks::append_near(const Vec3& x, double radius, const std::vector<int>& boxes,
                                 std::vector<int>& found) const {
  const double limit = square(radius * kBoxMargin);
  const std::size_t before = found.size();
  found.resize(before + boxes.size() * lane_count);
  int* const begin = found.data() + before;
  int count = 0;
  for (const int b : boxes) count += write_near(boxes_[b], b, x, limit, begin + count);
  found.resize(before + static_cast<std::size_t>(count));
}

}  // namespace flowskin::tracking
