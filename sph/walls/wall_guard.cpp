#include "sph/walls/wall_guard.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/triangle.h"

namespace flowskin::sph {

WallGuard::WallGuard(const std::vector<TriangleMesh>& meshes, double cell_size, const PeriodicBox& periodic,
                     const Box& reach)
    : cell_size_(cell_size) {
  Vec3 low = Vec3::Constant(1e300);
  const Vec3 margin = Vec3::Constant(2 * cell_size);
  for (const TriangleMesh& mesh : meshes) {
    for (const auto& t : mesh.triangles) {
      const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
      const Vec3 normal = (b - a).cross(c - a);
      if (normal.norm() == 0) continue;  // its edges belong to others
      const Vec3 lowest = a.cwiseMin(b).cwiseMin(c), highest = a.cwiseMax(b).cwiseMax(c);
      periodic.for_each_touching_image(lowest - margin, highest + margin, [&](const Vec3& shift) {
        low = low.cwiseMin(lowest + shift);
        triangles_.push_back({a + shift, b + shift, c + shift, normal.normalized()});
      });
    }
  }
  if (triangles_.empty()) return;
  origin_ = low - Vec3::Constant(2 * cell_size);

  // A triangle is entered in every cell of its box that its plane comes near.
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    const Triangle& tri = triangles_[t];
    const Box box{tri.a.cwiseMin(tri.b).cwiseMin(tri.c), tri.a.cwiseMax(tri.b).cwiseMax(tri.c)};
    if (!box.overlaps(reach)) continue;
    const auto first = cell_of(box.min.cwiseMax(reach.min), cell_size_);
    const auto last = cell_of(box.max.cwiseMin(reach.max), cell_size_);
    for (auto x = first[0]; x <= last[0]; ++x) {
      for (auto y = first[1]; y <= last[1]; ++y) {
        for (auto z = first[2]; z <= last[2]; ++z) {
          const Vec3 center = origin_ + cell_size_ * Vec3(double(x) + 0.5, double(y) + 0.5, double(z) + 0.5);
          if (std::abs(tri.normal.dot(center - tri.a)) <= 0.9 * cell_size_) entries_.push_back({cell_key(x, y, z), t});
        }
      }
    }
  }
  std::sort(entries_.begin(), entries_.end(), [](const CellEntry& a, const CellEntry& b) {
    return a.cell != b.cell ? a.cell < b.cell : a.triangle < b.triangle;
  });
}

std::array<std::int64_t, 3> WallGuard::cell_of(const Vec3& p, double cell_size) const {
  const Vec3 q = (p - origin_) / cell_size;
  return {static_cast<std::int64_t>(std::floor(q.x())), static_cast<std::int64_t>(std::floor(q.y())),
          static_cast<std::int64_t>(std::floor(q.z()))};
}

std::uint64_t WallGuard::cell_at(const Vec3& p, double cell_size) const {
  const auto [x, y, z] = cell_of(p, cell_size);
  return cell_key(x, y, z);
}

std::uint64_t WallGuard::cell_key(std::int64_t x, std::int64_t y, std::int64_t z) const {
  constexpr std::uint64_t mask = (std::uint64_t{1} << 21) - 1;
  return (static_cast<std::uint64_t>(x) & mask) << 42 | (static_cast<std::uint64_t>(y) & mask) << 21 |
         (static_cast<std::uint64_t>(z) & mask);
}

std::vector<std::uint64_t> WallGuard::cells_within(double distance) const {
  constexpr std::uint64_t mask = (std::uint64_t{1} << 21) - 1;
  const auto reach = static_cast<std::int64_t>(std::ceil(distance / cell_size_));
  std::vector<std::uint64_t> cells;
  for (std::size_t k = 0; k < entries_.size(); ++k) {
    const std::uint64_t cell = entries_[k].cell;
    if (k > 0 && entries_[k - 1].cell == cell) continue;
    for (auto x = -reach; x <= reach; ++x) {
      for (auto y = -reach; y <= reach; ++y) {
        for (auto z = -reach; z <= reach; ++z) {
          cells.push_back(cell_key(static_cast<std::int64_t>(cell >> 42 & mask) + x,
                                   static_cast<std::int64_t>(cell >> 21 & mask) + y,
                                   static_cast<std::int64_t>(cell & mask) + z));
        }
      }
    }
  }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

void WallGuard::query(const Vec3& box_min, const Vec3& box_max, std::vector<std::uint32_t>& found) const {
  found.clear();
  if (triangles_.empty()) return;
  for_each_cell(box_min, box_max, cell_size_, [&](std::uint64_t key) {
    auto entry = std::lower_bound(entries_.begin(), entries_.end(), key,
                                  [](const CellEntry& e, std::uint64_t k) { return e.cell < k; });
    for (; entry != entries_.end() && entry->cell == key; ++entry) found.push_back(entry->triangle);
  });
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
}

WallGuard::Crossing WallGuard::check(const Vec3& from, const Vec3& to, const std::vector<std::uint32_t>& candidates,
                                     bool with_rim) const {
  constexpr double rim_share = 0.05;  // of a gap's width
  const double hair = this->hair(), rim = with_rim ? rim_share * gap_width_ : hair;
  Crossing first;
  double first_share = 2;
  for (const std::uint32_t t : candidates) {
    const Triangle& tri = triangles_[t];
    const double from_height = tri.normal.dot(from - tri.a), to_height = tri.normal.dot(to - tri.a);
    const bool opposite = (from_height > 0) != (to_height > 0);
    const bool approaches = std::abs(to_height) < hair && std::abs(to_height) < std::abs(from_height);
    if (!opposite && !approaches) continue;
    const double share = opposite ? from_height / (from_height - to_height) : 1;
    const Vec3 p = from + share * (to - from);
    // Inside the triangle, its rim widened by a hair, so that nothing slips between two triangles that share an edge.
    const double area = tri.normal.dot((tri.b - tri.a).cross(tri.c - tri.a));
    const double wa = tri.normal.dot((tri.b - p).cross(tri.c - p)), wb = tri.normal.dot((tri.c - p).cross(tri.a - p));
    const double rim_a = hair * (tri.c - tri.b).norm(), rim_b = hair * (tri.a - tri.c).norm(),
                 rim_c = hair * (tri.b - tri.a).norm();
    if (wa < -rim_a || wb < -rim_b || area - wa - wb < -rim_c) {
      if (!with_rim || (closest_on_triangle(p, tri.a, tri.b, tri.c, tri.normal) - p).norm() > rim) continue;
    }
    if (share < first_share) {
      first_share = share;
      first = {true, from_height > 0 ? tri.normal : Vec3(-tri.normal)};
    }
  }
  return first;
}

std::size_t WallGuard::memory_bytes() const {
  return triangles_.capacity() * sizeof(Triangle) + entries_.capacity() * sizeof(CellEntry) +
         gap_cells_.capacity() * sizeof(std::uint64_t);
}

}  // namespace flowskin::sph
