// Where a patch passes through itself or through the mesh that it is for.
#pragma once

#include <vector>

#include "tracking/extraction/marching_cubes.h"
#include "tracking/repair/replace_region.h"

namespace flowskin::tracking {

/// The triangles of a patch and some of the mesh, in this order, with the vertices that they use.
SurfaceGeometry geometry_of(const MeshToMend& mesh, const MeshPatch& patch, const std::vector<int>& others = {});

class PatchCrossings {
 public:
  /// Keeps references to all.
  /// @param near triangles of the mesh around the patch; those that it removes may be among them
  PatchCrossings(const SparseGrid& grid, const MeshToMend& mesh, const std::vector<int>& near)
      : grid_(grid), mesh_(mesh), near_(near) {}

  /// The cells of triangles that intersect (self_intersections), one of the two at least being of the patch.
  std::vector<CellSet::Cell> cells(const MeshPatch& patch) const;

 private:
  const SparseGrid& grid_;
  const MeshToMend& mesh_;
  const std::vector<int>& near_;
};

}  // namespace flowskin::tracking
