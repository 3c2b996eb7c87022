#include "scenes/io/polygon.h"

#include <Eigen/Geometry>

namespace flowskin::scenes {
namespace {

using sph::Vec3;

/// Twice the area vector of the polygon [Newell]: its direction is the normal even where corners are reflex.
Vec3 area_vector(const std::vector<Vec3>& positions, const std::vector<int>& corners) {
  Vec3 sum = Vec3::Zero();
  const Vec3& origin = positions[corners[0]];
  for (std::size_t i = 0; i + 1 < corners.size(); ++i)
    sum += (positions[corners[i]] - origin).cross(positions[corners[i + 1]] - origin);
  return sum;
}

/// True where corner i is convex and no other corner lies in the triangle that it makes with its neighbours.
bool is_ear(const std::vector<Vec3>& positions, const std::vector<int>& corners, std::size_t i, const Vec3& normal) {
  const std::size_t count = corners.size();
  const std::array<int, 3> ear{corners[(i + count - 1) % count], corners[i], corners[(i + 1) % count]};
  const Vec3 &a = positions[ear[0]], &b = positions[ear[1]], &c = positions[ear[2]];
  const auto side = [&normal](const Vec3& p, const Vec3& q, const Vec3& r) { return normal.dot((q - p).cross(r - p)); };
  if (!(side(a, b, c) > 0)) return false;
  for (std::size_t k = 0; k + 3 < count; ++k) {
    const int other = corners[(i + 2 + k) % count];
    const Vec3& p = positions[other];
    // A corner at the same place as one of the ear's (a polygon with a bridge to a hole) does not block it.
    if (p == a || p == b || p == c) continue;
    if (side(a, b, p) >= 0 && side(b, c, p) >= 0 && side(c, a, p) >= 0) return false;
  }
  return true;
}

}  // namespace

std::vector<std::array<int, 3>> triangulate_polygon(const std::vector<Vec3>& positions, std::vector<int> corners) {
  std::vector<std::array<int, 3>> triangles;
  if (corners.size() < 3) return triangles;
  triangles.reserve(corners.size() - 2);
  const Vec3 normal = corners.size() > 3 ? area_vector(positions, corners) : Vec3::Zero();
  std::size_t at = 1;  // where to look for the next ear: going round makes better triangles than starting over
  while (corners.size() > 3) {
    const std::size_t count = corners.size();
    std::size_t tried = 0;
    while (tried < count && !is_ear(positions, corners, (at + tried) % count, normal)) ++tried;
    if (tried == count) break;
    const std::size_t i = (at + tried) % count;
    triangles.push_back({corners[(i + count - 1) % count], corners[i], corners[(i + 1) % count]});
    corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(i));
    at = i;
  }
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) triangles.push_back({corners[0], corners[i], corners[i + 1]});
  return triangles;
}

}  // namespace flowskin::scenes
