// The field's neighbour lookup: particles in blocks, a nanoflann k-d tree over the blocks. Internal to tracking/field.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "tracking/field/metaballs/lanes.h"
#include "tracking/particles.h"

namespace flowskin::tracking {

/// Three components of four particles side by side.
struct GroupVectors {
  Lanes x, y, z;
};

/// The bounding boxes of four groups side by side (m). Lanes without a group are boxes infinitely far away.
struct GroupBoxes {
  Lanes low_x, low_y, low_z, high_x, high_y, high_z;
};

/// Indices of groups of four particles, ascending.
using GroupList = std::span<const int>;

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

  /// False where the particles have no velocities.
  bool moving() const { return !velocities_.empty(); }
  /// Positions of a group (m). Lanes without a particle lie very far away, at finite places.
  const GroupVectors& positions(int group) const { return positions_[group]; }
  /// Velocities of a group (m/s), zero in lanes without a particle. @pre moving()
  const GroupVectors& velocities(int group) const { return velocities_[group]; }
  /// Index of the particle in a lane of a group, -1 where there is none.
  int particle(int group, int lane) const { return particles_[group * lane_count + lane]; }

  /// Indices of the groups whose bounding box is not farther than `radius` from x (m). The result lives in `found`,
  /// which grows where it is too small and never shrinks.
  GroupList near(const Vec3& x, double radius, std::vector<int>& found) const;

  /// The same in two steps for many points in one place. Indices of those fours of group boxes, ascending, of which one
  /// may be nearer than `radius` (m) to a point of the box from `low` to `high`. Clears `found` first.
  void boxes_near(const Vec3& low, const Vec3& high, double radius, std::vector<int>& found) const;
  /// Appends the groups of these fours whose box is not farther than `radius` from x.
  void append_near(const Vec3& x, double radius, const std::vector<int>& boxes, std::vector<int>& found) const;

 private:
  struct Tree;
  struct Block {
    int first_boxes;  ///< Boxes [first_boxes, last_boxes) are those of its groups.
    int last_boxes;
  };
  /// Writes the particles from `begin` to `end` and their boxes where the block has its place.
  void fill_block(const Block& block, const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities,
                  const int* begin, const int* end);
  /// Indices of the blocks that may reach to within `radius` of x, ascending. Clears `found` first.
  void blocks_near(const Vec3& x, double radius, std::vector<int>& found) const;

  std::vector<Block> blocks_;
  std::vector<GroupBoxes> boxes_;
  std::vector<GroupVectors> positions_;   // four for each element of boxes_
  std::vector<GroupVectors> velocities_;  // as many, or none
  std::vector<int> particles_;            // four for each element of positions_
  double largest_block_ = 0;              // half the diagonal of the largest block's box (m)
  std::unique_ptr<Tree> tree_;
};

}  // namespace flowskin::tracking
