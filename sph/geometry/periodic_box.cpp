#include "sph/geometry/periodic_box.h"

#include <algorithm>
#include <vector>

namespace flowskin::sph {

namespace {

// Where the edge from a to b meets the plane; the same to the last bit for the edge from b to a, so that neighbouring
// triangles still share their edges when both are cut.
Vec3 meeting_point(Vec3 a, Vec3 b, int axis, double plane) {
  if (std::lexicographical_compare(b.data(), b.data() + 3, a.data(), a.data() + 3)) std::swap(a, b);
  Vec3 p = a + (plane - a[axis]) / (b[axis] - a[axis]) * (b - a);
  p[axis] = plane;
  return p;
}

// The part of a convex polygon on one side of a plane across an axis [Sutherland and Hodgman 1974].
std::vector<Vec3> cut(const std::vector<Vec3>& polygon, int axis, double plane, double side) {
  std::vector<Vec3> kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec3 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    const double height_a = side * (a[axis] - plane), height_b = side * (b[axis] - plane);
    if (height_a >= 0) kept.push_back(a);
    if ((height_a > 0 && height_b < 0) || (height_a < 0 && height_b > 0)) {
      kept.push_back(meeting_point(a, b, axis, plane));
    }
  }
  return kept;
}

}  // namespace

TriangleMesh PeriodicBox::clip(const TriangleMesh& mesh) const {
  if (!any()) return mesh;
  TriangleMesh result;
  for (const auto& t : mesh.triangles) {
    std::vector<Vec3> polygon{mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
    for (int a = 0; a < 3; ++a) {
      if (!axes_[a]) continue;
      polygon = cut(cut(polygon, a, box_.min[a], 1), a, box_.max[a], -1);
    }
    const int first = static_cast<int>(result.positions.size()), count = static_cast<int>(polygon.size());
    if (count < 3) continue;
    result.positions.insert(result.positions.end(), polygon.begin(), polygon.end());
    for (int k = 2; k < count; ++k) result.triangles.push_back({first, first + k - 1, first + k});
  }
  return result;
}

}  // namespace flowskin::sph
