// The field's neighbour lookup: particles in small blocks, a nanoflann k-d tree over the blocks. Internal to
// tracking/field.
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

/// A few particles that follow each other along the Hilbert curve, with their bounding box.
struct ParticleBlock {
  Vec3 low, high;   ///< m
  int first_group;  ///< Groups [first_group, last_group) hold the block's particles.
  int last_group;
};

/// One k-d tree query per point of evaluation would cost more than the field itself. So the tree holds blocks of up to
/// 16 particles: a query meets few of them, and their particles are tested four at a time by the caller.
class ParticleBlocks {
 public:
  /// `reach` is the radius of most queries (m); it decides how large blocks may be. `velocities` may be empty.
  ParticleBlocks(const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities, double reach);
  ~ParticleBlocks();

  const std::vector<ParticleBlock>& blocks() const { return blocks_; }
  const std::vector<ParticleGroup>& groups() const { return groups_; }
  /// Index of the particle in a lane, -1 where there is none.
  int particle(int group, int lane) const { return particles_[group * lane_count + lane]; }
  /// Blocks whose bounding box is nearer than `radius` to x (m), ascending. Clears `found` first.
  void near(const Vec3& x, double radius, std::vector<int>& found) const;

 private:
  struct Tree;
  void add_block(const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities, const int* begin,
                 const int* end);

  std::vector<ParticleBlock> blocks_;
  std::vector<ParticleGroup> groups_;
  std::vector<int> particles_;
  double largest_block_ = 0;  // half the diagonal of the largest bounding box (m)
  std::unique_ptr<Tree> tree_;
};

}  // namespace flowskin::tracking
