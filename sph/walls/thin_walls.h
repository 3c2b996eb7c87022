// Walls so thin that fluid on one side would feel fluid on the other: pairs whose line of sight they cut.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sph/geometry/periodic_box.h"
#include "sph/walls/wall_guard.h"

namespace flowskin::sph {

/// The triangles that fluid may lie on both sides of, within the reach of its kernel: those of open surfaces, and of
/// closed ones where another face is as near. Two particles do not see each other where the straight line between them
/// crosses such a wall. A line that only cuts off a corner, in through one face and out through another that turns by
/// less than 120 degrees, counts as free: both are on the same side.
class ThinWalls {
 public:
  ThinWalls() = default;
  /// @param guard of all triangles of the meshes
  /// @param spacing of the fluid (m)
  /// @param reach of the fluid's lists (m)
  /// @param place where the walls matter
  ThinWalls(const std::vector<TriangleMesh>& meshes, const WallGuard& guard, double spacing, double reach,
            const PeriodicBox& periodic, const Box& place = everywhere());

  bool empty() const { return guard_.triangle_count() == 0; }
  /// Whether such a wall may lie within reach of a cluster of particles around the point, three spacings long.
  bool near(const Vec3& center) const;
  /// Sets bit k of hidden[j] where the wall is between targets[k] and sources[j].
  /// @param targets at most eight places (m), within three spacings of one another
  /// @param sources places (m); those beyond reach of all targets do not matter
  void hide(std::span<const Vec3> targets, std::span<const Vec3> sources, std::vector<std::uint8_t>& hidden) const;

  std::size_t memory_bytes() const { return guard_.memory_bytes() + cells_.capacity() * sizeof(std::uint64_t); }

 private:
  double reach_ = 0;                  // m
  WallGuard guard_;                   // of the thin walls only
  std::vector<std::uint64_t> cells_;  // of guard_, from which one may be within reach; in ascending order
};

}  // namespace flowskin::sph
