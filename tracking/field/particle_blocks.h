// The field's neighbour lookup: particles in blocks, a nanoflann k-d tree over the blocks. Internal to tracking/field.
#pragma once

#include <memory>
#include <vector>

#include "tracking/field/lanes.h"
#include "tracking/particles.h"

namespace flowskin::tracking {

/// Four particles side by side. Lanes without a particle lie infinitely far away and do not move.
struct ParticleGroup {
  Lanes x, y, z;     ///< m
  Lanes vx, vy, vz;  ///< m/s
};

/// The bounding boxes of four groups side by side (m). Lanes without a group are boxes infinitely far away.
struct GroupBoxes {
  Lanes low_x, low_y, low_z, high_x, high_y, high_z;
};

/// One k-d tree query over particles for each point of evaluation would cost more than the field itself. So particles
/// are sorted along the Hilbert curve and cut into blocks, and the tree holds the blocks: a query meets few of them,
/// and what is in them is tested four at a time: first the boxes of groups of four particles, then (by the caller)
/// those.
class ParticleBlocks {
 public:
  /// `reach` is the radius of most queries (m); it decides how large blocks may be. `velocities` may be empty.
  ParticleBlocks(const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities, double reach);
  ~ParticleBlocks();
  ParticleBlocks(ParticleBlocks&&) noexcept;

  const ParticleGroup& group(int index) const { return groups_[index]; }
  /// Index of the particle in a lane of a group, -1 where there is none.
  int particle(int group, int lane) const { return particles_[group * lane_count + lane]; }
  /// Indices of the groups whose bounding box is not farther than `radius` from x (m), ascending. The result lives in
  /// `found`, which grows where it is too small and never shrinks.
  /// @return How many there are, at the beginning of `found`.
  int near(const Vec3& x, double radius, std::vector<int>& found) const;

 private:
  struct Tree;
  struct Block {
    int first_boxes;  ///< Boxes [first_boxes, last_boxes) are those of its groups.
    int last_boxes;
  };
  void add_block(const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities, const int* begin,
                 const int* end);

  std::vector<Block> blocks_;
  std::vector<GroupBoxes> boxes_;
  std::vector<ParticleGroup> groups_;  // four for each element of boxes_
  std::vector<int> particles_;         // four for each element of groups_
  double largest_block_ = 0;           // half the diagonal of the largest block's box (m)
  std::unique_ptr<Tree> tree_;
};

}  // namespace flowskin::tracking
