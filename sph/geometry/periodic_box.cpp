#include "sph/geometry/periodic_box.h"

#include <vector>

#include "sph/geometry/clip.h"

namespace flowskin::sph {

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
