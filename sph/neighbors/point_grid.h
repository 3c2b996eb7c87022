// A growing set of points with the question "is one of them nearer than ...?"; for setting up, not for the time loop.
#pragma once

#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "sph/geometry/periodic_box.h"
#include "sph/geometry/triangle_mesh.h"

namespace flowskin::sph {

/// Points hashed into cells. Unlike a kd-tree it can be asked between insertions.
class PointGrid {
 public:
  /// @param cell_size no query may ask for a greater distance (m)
  explicit PointGrid(double cell_size) : cell_size_(cell_size) {}

  void insert(const Vec3& p) { cells_[key(cell(p))].push_back(p); }

  /// Whether a point lies nearer to p than `distance` (<= cell_size).
  bool has_near(const Vec3& p, double distance) const {
    bool found = false;
    for_each_near(p, distance, [&](const Vec3&) { return found = true; });
    return found;
  }

  /// Calls visit(point) for the points nearer to p than `distance` (<= cell_size), perhaps more than once, until it
  /// says true.
  template <typename Visit>
  void for_each_near(const Vec3& p, double distance, Visit visit) const {
    const Cell low = cell(p - Vec3::Constant(distance)), high = cell(p + Vec3::Constant(distance));
    for (std::int64_t x = low.x; x <= high.x; ++x) {
      for (std::int64_t y = low.y; y <= high.y; ++y) {
        for (std::int64_t z = low.z; z <= high.z; ++z) {
          const auto found = cells_.find(key({x, y, z}));
          if (found == cells_.end()) continue;
          for (const Vec3& other : found->second) {
            if ((other - p).squaredNorm() < distance * distance && visit(other)) return;
          }
        }
      }
    }
  }

 private:
  struct Cell {
    std::int64_t x, y, z;
  };
  Cell cell(const Vec3& p) const {
    return {static_cast<std::int64_t>(std::floor(p.x() / cell_size_)),
            static_cast<std::int64_t>(std::floor(p.y() / cell_size_)),
            static_cast<std::int64_t>(std::floor(p.z() / cell_size_))};
  }
  // Two cells may share a key: the distance test keeps the answer right.
  static std::uint64_t key(const Cell& c) {
    return static_cast<std::uint64_t>(c.x) * 73856093U ^ static_cast<std::uint64_t>(c.y) * 19349663U ^
           static_cast<std::uint64_t>(c.z) * 83492791U;
  }

  double cell_size_;
  std::unordered_map<std::uint64_t, std::vector<Vec3>> cells_;
};

/// Whether a point of the grid, or an image of it, lies nearer to p than `distance`.
inline bool has_near_image(const PointGrid& grid, const Vec3& p, double distance, const PeriodicBox& periodic) {
  bool found = false;
  const Vec3 reach = Vec3::Constant(distance);
  periodic.for_each_touching_image(p - reach, p + reach,
                                   [&](const Vec3& shift) { found = found || grid.has_near(p + shift, distance); });
  return found;
}

}  // namespace flowskin::sph
