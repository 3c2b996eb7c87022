#include "tracking/topology/patch_crossings.h"

#include <algorithm>
#include <limits>

#include "tracking/mesh/self_intersections.h"

namespace flowskin::tracking {

SurfaceGeometry geometry_of(const MeshToMend& mesh, const MeshPatch& patch, const std::vector<int>& others) {
  const auto count = static_cast<int>(mesh.positions.size());
  SurfaceGeometry geometry;
  geometry.triangles = patch.triangles;
  for (int t : others) geometry.triangles.push_back(mesh.triangles[t]);
  std::vector<int> used;
  for (const Triangle& triangle : geometry.triangles) used.insert(used.end(), triangle.begin(), triangle.end());
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  geometry.positions.reserve(used.size());
  for (int vertex : used)
    geometry.positions.push_back(vertex < count ? mesh.positions[vertex] : patch.born[vertex - count]);
  for (Triangle& triangle : geometry.triangles) {
    for (int& vertex : triangle)
      vertex = static_cast<int>(std::lower_bound(used.begin(), used.end(), vertex) - used.begin());
  }
  return geometry;
}

std::vector<CellSet::Cell> PatchCrossings::cells(const MeshPatch& patch) const {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::max()), high = -low;
  const SurfaceGeometry alone = geometry_of(mesh_, patch);
  for (const Vec3& x : alone.positions) {
    low = low.cwiseMin(grid_.coordinates(x));
    high = high.cwiseMax(grid_.coordinates(x));
  }
  const Box around{low, high};
  std::vector<int> others;
  for (int t : near_) {
    if (!std::binary_search(patch.removed.begin(), patch.removed.end(), t) && mesh_.boxes[t].overlaps(around))
      others.push_back(t);
  }
  const SurfaceGeometry all = geometry_of(mesh_, patch, others);
  std::vector<CellSet::Cell> found;
  for (const auto& [first, second] : self_intersections(all.positions, all.triangles)) {
    if (first >= std::ssize(patch.triangles)) continue;
    for (int t : {first, second}) {
      const Box box = box_of(grid_, all.triangles[t], all.positions);
      add_cells(box.low, box.high, found);
    }
  }
  return found;
}

}  // namespace flowskin::tracking
