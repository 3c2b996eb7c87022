// A box whose opposite faces are one and the same along some of its axes.
#pragma once

#include <array>
#include <cmath>

#include "sph/geometry/triangle_mesh.h"

namespace flowskin::sph {

/// What leaves the box through a periodic face comes back through the opposite one. Lengths in m.
class PeriodicBox {
 public:
  PeriodicBox() = default;
  PeriodicBox(const Box& box, const std::array<bool, 3>& axes) : axes_(axes), box_(box) {
    for (int a = 0; a < 3; ++a) period_[a] = axes[a] ? box.max[a] - box.min[a] : 0;
  }

  bool any() const { return axes_[0] || axes_[1] || axes_[2]; }
  bool along(int axis) const { return axes_[axis]; }
  /// Length of the box along its periodic axes, 0 along the others.
  const Vec3& period() const { return period_; }
  const Box& box() const { return box_; }

  /// The image of p inside the box, its upper faces left out; other axes stay as they are.
  Vec3 wrap(Vec3 p) const {
    for (int a = 0; a < 3; ++a) {
      if (!axes_[a] || (p[a] >= box_.min[a] && p[a] < box_.max[a])) continue;
      p[a] -= period_[a] * std::floor((p[a] - box_.min[a]) / period_[a]);
      if (!(p[a] < box_.max[a])) p[a] = box_.min[a];  // a hair below the box, rounded up
    }
    return p;
  }

  /// The part of a mesh inside the box along the periodic axes, for walls: triangles that reach out of it are cut.
  TriangleMesh clip(const TriangleMesh& mesh) const;

  /// The shortest of the differences between two points and each other's images.
  Vec3 shortest(Vec3 difference) const {
    for (int a = 0; a < 3; ++a) {
      if (axes_[a]) difference[a] -= period_[a] * std::round(difference[a] / period_[a]);
    }
    return difference;
  }

  /// Calls visit(shift) for all shifts (m) that bring something with the bounding box [min, max] to touch the periodic
  /// box; just once, with zero, where nothing is periodic.
  template <typename Visit>
  void for_each_touching_image(const Vec3& min, const Vec3& max, Visit visit) const {
    std::array<int, 3> first{}, last{};
    for (int a = 0; a < 3; ++a) {
      if (!axes_[a]) continue;
      first[a] = static_cast<int>(std::ceil((box_.min[a] - max[a]) / period_[a]));
      last[a] = static_cast<int>(std::floor((box_.max[a] - min[a]) / period_[a]));
    }
    for (int i = first[0]; i <= last[0]; ++i) {
      for (int j = first[1]; j <= last[1]; ++j) {
        for (int k = first[2]; k <= last[2]; ++k) {
          visit(Vec3(i * period_[0], j * period_[1], k * period_[2]));
        }
      }
    }
  }

 private:
  std::array<bool, 3> axes_{};
  Box box_;
  Vec3 period_ = Vec3::Zero();
};

}  // namespace flowskin::sph
