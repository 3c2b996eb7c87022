// Where one of two surfaces has a hole or a part that the other lacks.
#pragma once

#include <vector>

#include "tracking/extraction/cell_set.h"
#include "tracking/extraction/marching_cubes.h"

namespace flowskin::tracking {

/// Compares the topology of two closed surfaces place by place. The angles missing from 360 degrees at the vertices of
/// a surface add up to 2 pi times its Euler characteristic (Gauss and Bonnet), and where the surfaces are nearly the
/// same, so are these sums over any window. A hole that only one of them has shows as -4 pi, a part as 4 pi.
class LocalTopology {
 public:
  LocalTopology(const SparseGrid& grid, const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                const SurfaceGeometry& fresh);
  /// The cells among `where` in whose window, two cells to all sides, the sums differ by more than `share` of 4 pi.
  std::vector<CellSet::Cell> differing(const CellSet& where, double share) const;

 private:
  void add(const SparseGrid& grid, double sign, const std::vector<Vec3>& positions,
           const std::vector<Triangle>& triangles);

  struct Defect {
    CellSet::Cell cell;
    double sum;
  };
  std::vector<Defect> defects_;  // of the mesh minus that of the fresh surface (rad), by cell
};

}  // namespace flowskin::tracking
