// The backstop that no particle passes a wall: tests paths against the triangles themselves.
#pragma once

#include <cstdint>
#include <vector>

#include "sph/periodic_box.h"
#include "sph/triangle_mesh.h"

namespace flowskin::sph {

/// Triangles of all walls, found by the cells of a uniform grid that they touch.
class WallGuard {
 public:
  WallGuard() = default;
  /// @param cell_size edge of the grid's cells (m); about two spacings
  /// @param periodic walls are entered with their images that come within two cells of the box
  WallGuard(const std::vector<TriangleMesh>& meshes, double cell_size, const PeriodicBox& periodic = {});

  /// Replaces `found` by the triangles that may touch the box, in ascending order.
  void query(const Vec3& box_min, const Vec3& box_max, std::vector<std::uint32_t>& found) const;

  struct Crossing {
    bool crossed = false;
    Vec3 normal = Vec3::Zero();  ///< Unit normal of the first triangle met, towards the start of the path.
  };
  /// Whether the straight path from `from` to `to` passes one of the triangles, or ends nearer than a hair
  /// (1e-6 cell sizes) to one.
  Crossing check(const Vec3& from, const Vec3& to, const std::vector<std::uint32_t>& candidates) const;

  std::size_t triangle_count() const { return triangles_.size(); }
  std::size_t memory_bytes() const;

 private:
  struct Triangle {
    Vec3 a, b, c, normal;
  };
  struct CellEntry {
    std::uint64_t cell;
    std::uint32_t triangle;
  };
  std::uint64_t cell_key(std::int64_t x, std::int64_t y, std::int64_t z) const;

  double cell_size_ = 1;
  Vec3 origin_ = Vec3::Zero();
  std::vector<Triangle> triangles_;
  std::vector<CellEntry> entries_;  // ordered by cell, then triangle
};

}  // namespace flowskin::sph
