// The backstop that no particle passes a wall: tests paths against the triangles themselves.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sph/geometry/clip.h"
#include "sph/geometry/periodic_box.h"
#include "sph/geometry/triangle_mesh.h"

namespace flowskin::sph {

/// What a guard did to a particle's path.
struct Hold {
  bool held = false;              ///< The path passed a wall: its end was put back.
  bool kept_out = false;          ///< It came into a gap that is too narrow for a particle.
  bool squeezed_through = false;  ///< There was no room between walls: it passes a moving one.

  bool any() const { return held || kept_out || squeezed_through; }
  void add(const Hold& other) {
    held = held || other.held;
    kept_out = kept_out || other.kept_out;
    squeezed_through = squeezed_through || other.squeezed_through;
  }
};

/// Triangles of all walls, found by the cells of a uniform grid that they touch.
class WallGuard {
 public:
  WallGuard() = default;
  /// @param cell_size edge of the grid's cells (m); about two spacings
  /// @param periodic walls are entered with their images that come within two cells of the box
  /// @param reach triangles are found in this box only
  WallGuard(const std::vector<TriangleMesh>& meshes, double cell_size, const PeriodicBox& periodic = {},
            const Box& reach = everywhere());

  /// Replaces `found` by the triangles that may touch the box, in ascending order.
  void query(const Vec3& box_min, const Vec3& box_max, std::vector<std::uint32_t>& found) const;

  /// query(), without triangles whose own box or plane does not touch the box.
  void query_touching(const Vec3& box_min, const Vec3& box_max, std::vector<std::uint32_t>& found) const;

  /// query() around a box, `margin` (m) wide, wider near gaps; says whether it is near one.
  bool collect(const Vec3& low, const Vec3& high, double margin, std::vector<std::uint32_t>& found) const;

  struct Crossing {
    bool crossed = false;
    Vec3 normal = Vec3::Zero();  ///< Unit normal of the first triangle met, towards the start of the path.
  };
  /// Whether the straight path from `from` to `to` passes one of the triangles, or ends nearer than a hair
  /// (1e-6 cell sizes) to one.
  /// @param with_rim triangles are wider by a twentieth of the width of gaps: cracks between them are closed
  Crossing check(const Vec3& from, const Vec3& to, const std::vector<std::uint32_t>& candidates,
                 bool with_rim = false) const;

  /// A particle has a size: a gap between walls that is narrower lets nothing through. A place is in a gap where two
  /// walls are opposite each other, in directions more than 120 degrees apart, and their nearest points there closer
  /// together than `width` (m). Corners of 60 degrees or more have no such places.
  /// @param samples points on the walls (m), everywhere within `sample_spacing` (m) of one another
  void find_gaps(const std::vector<Vec3>& samples, double sample_spacing, double width, const PeriodicBox& periodic);
  /// Where the path comes into a gap: leads `to` along it, or back to `from`. What starts in a gap is free to leave it.
  /// @param candidates from collect(), for a box around the path
  /// @param normal out: unit vector out of the gap
  bool keep_out(const Vec3& from, const std::vector<std::uint32_t>& candidates, Vec3& to, Vec3& normal) const;

  /// Where a point touches a wall: the nearest point of a triangle that is nearer than the width of gaps.
  struct Touch {
    Vec3 place, way;  ///< m; the way leads from the point to the place
    double distance;
    std::uint32_t triangle;
    std::uint32_t wall = 0;             ///< Which one, where several are looked at together,
    Vec3 place_at_rest = Vec3::Zero();  ///< and the place in that one's own frame.
  };
  /// Adds the touches of a point; says whether it lies beside all triangles.
  bool add_touches(const Vec3& p, const std::vector<std::uint32_t>& candidates, std::vector<Touch>& touches) const;
  /// Whether no other triangle of this wall that the place lies on comes nearer.
  bool is_nearest_around(const Touch& touch, const std::vector<Touch>& touches) const;

  /// Two touches opposite each other.
  struct Facing {
    bool found = false;
    std::size_t first = 0, second = 0;
    Vec3 out = Vec3::Zero();  ///< Leads out from between them; of any length (m).
  };
  /// The narrowest pair of touches opposite each other whose places are nearer together than `width` (m).
  /// @param counts whether a pair counts: a function of two touches
  template <typename Counts>
  static Facing narrowest(const std::vector<Touch>& touches, double width, Counts counts);
  /// Pieces of a path in which it is looked at for gaps.
  static int path_pieces(double length, double width);

  struct Triangle {
    Vec3 a, b, c, normal;
  };
  const Triangle& triangle(std::uint32_t t) const { return triangles_[t]; }
  std::size_t triangle_count() const { return triangles_.size(); }
  /// The cells that a place is in from which a triangle may be within the distance (m), in ascending order.
  std::vector<std::uint64_t> cells_within(double distance) const;
  std::uint64_t cell_at(const Vec3& p) const { return cell_at(p, cell_size_); }
  std::size_t memory_bytes() const;

 private:
  struct CellEntry {
    std::uint64_t cell;
    std::uint32_t triangle;
  };
  std::uint64_t cell_key(std::int64_t x, std::int64_t y, std::int64_t z) const;
  std::array<std::int64_t, 3> cell_of(const Vec3& p, double cell_size) const;
  std::uint64_t cell_at(const Vec3& p, double cell_size) const;
  /// Calls visit(key) for the cells that touch the box.
  template <typename Visit>
  void for_each_cell(const Vec3& low, const Vec3& high, double cell_size, Visit visit) const;
  double hair() const { return 1e-6 * cell_size_; }
  /// Whether a place in the box may be in a gap.
  bool near_gap(const Vec3& low, const Vec3& high) const;
  bool is_on_wall(const Vec3& p, double distance, const std::vector<std::uint32_t>& candidates) const;
  /// Whether p is in a gap; the normal leads out of it and has any length.
  Crossing gap_at(const Vec3& p, const std::vector<std::uint32_t>& candidates) const;
  /// The same of the first place of a path that is in a gap, with a unit normal; none where the path begins in one.
  Crossing enter_gap(const Vec3& from, const Vec3& to, const std::vector<std::uint32_t>& candidates) const;

  double cell_size_ = 1;
  Vec3 origin_ = Vec3::Zero();
  std::vector<Triangle> triangles_;
  std::vector<CellEntry> entries_;  // ordered by cell, then triangle
  double gap_width_ = 0;
  std::vector<std::uint64_t> gap_cells_;  // of the size gap_width_, with a gap within that of them; in ascending order
};

template <typename Visit>
void WallGuard::for_each_cell(const Vec3& low, const Vec3& high, double cell_size, Visit visit) const {
  const auto first = cell_of(low, cell_size), last = cell_of(high, cell_size);
  for (auto x = first[0]; x <= last[0]; ++x) {
    for (auto y = first[1]; y <= last[1]; ++y) {
      for (auto z = first[2]; z <= last[2]; ++z) visit(cell_key(x, y, z));
    }
  }
}

template <typename Counts>
WallGuard::Facing WallGuard::narrowest(const std::vector<Touch>& touches, double width, Counts counts) {
  constexpr double opposite = -0.5;  // cosine: directions more than 120 degrees apart
  Facing result;
  double least = width;
  for (std::size_t k = 0; k < touches.size(); ++k) {
    for (std::size_t l = 0; l < k; ++l) {
      const Touch &a = touches[k], &b = touches[l];
      if (a.way.dot(b.way) > opposite * a.distance * b.distance) continue;
      const Vec3 across = a.place - b.place;
      const double apart = across.norm();
      if (!(apart < least) || !counts(a, b)) continue;
      least = apart;
      const Vec3 out = -0.5 * (a.way + b.way);
      result = {true, k, l, out - out.dot(across) / (apart * apart) * across};
    }
  }
  return result;
}

}  // namespace flowskin::sph
