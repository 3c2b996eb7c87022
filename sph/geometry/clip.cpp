#include "sph/geometry/clip.h"

#include <algorithm>
#include <limits>

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

}  // namespace

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

std::vector<Vec3> clip(std::vector<Vec3> polygon, const Box& box) {
  if (std::all_of(polygon.begin(), polygon.end(), [&](const Vec3& p) { return contains(box, p); })) return polygon;
  for (int a = 0; a < 3 && !polygon.empty(); ++a) {
    polygon = cut(cut(polygon, a, box.min[a], 1), a, box.max[a], -1);
  }
  return polygon;
}

Box everywhere() {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  return {Vec3::Constant(-infinity), Vec3::Constant(infinity)};
}

}  // namespace flowskin::sph
