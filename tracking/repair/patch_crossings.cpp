#include "tracking/repair/patch_crossings.h"

#include <algorithm>
#include <utility>

#include "tracking/mesh/self_intersections.h"

namespace flowskin::tracking {

SurfaceGeometry geometry_of(const MeshToMend& mesh, const MeshPatch& patch, const std::vector<int>& others) {
  const auto count = static_cast<int>(mesh.positions.size());
  SurfaceGeometry geometry;
  geometry.triangles = patch.triangles;
  for (int t : others) geometry.triangles.push_back(mesh.triangles[t]);
  std::vector<int> number(mesh.positions.size() + patch.born.size(), -1);
  for (Triangle& triangle : geometry.triangles) {
    for (int& vertex : triangle) {
      int& local = number[vertex];
      if (local < 0) {
        local = static_cast<int>(geometry.positions.size());
        geometry.positions.push_back(vertex < count ? mesh.positions[vertex] : patch.born[vertex - count]);
      }
      vertex = local;
    }
  }
  return geometry;
}

std::vector<CellSet::Cell> PatchCrossings::cells(const MeshPatch& patch) const {
  const SurfaceGeometry alone = geometry_of(mesh_, patch);
  std::vector<CellSet::Cell> taken;
  for (const Triangle& triangle : alone.triangles) {
    const Box box = box_of(grid_, triangle, alone.positions);
    add_cells(box.min, box.max, taken);
  }
  const CellSet around(std::move(taken));
  std::vector<int> others;
  for (int t : near_) {
    if (!std::binary_search(patch.removed.begin(), patch.removed.end(), t) &&
        meets(around, mesh_.boxes[t].min, mesh_.boxes[t].max))
      others.push_back(t);
  }
  const SurfaceGeometry all = geometry_of(mesh_, patch, others);
  std::vector<CellSet::Cell> found;
  for (const auto& [first, second] : self_intersections(all.positions, all.triangles)) {
    if (first >= std::ssize(patch.triangles)) continue;
    for (int t : {first, second}) {
      const Box box = box_of(grid_, all.triangles[t], all.positions);
      add_cells(box.min, box.max, found);
    }
  }
  return found;
}

}  // namespace flowskin::tracking
