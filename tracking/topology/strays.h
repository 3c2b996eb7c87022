// Where one of two surfaces has a part that the other lacks.
#pragma once

#include <vector>

#include "tracking/extraction/cell_set.h"
#include "tracking/extraction/marching_cubes.h"

namespace flowskin::tracking {

/// How far the vertices of two surfaces are from the other surface, as far as that looks the same way (at most 60
/// degrees off). For features
/// below the size of a cell, which the nodes of a grid do not see.
class Strays {
 public:
  /// @param farthest distances are measured up to here (m)
  Strays(const SparseGrid& grid, double farthest, const std::vector<Vec3>& positions,
         const std::vector<Triangle>& triangles, const SurfaceGeometry& fresh);
  /// Only of the vertices in some cells, against the fresh surface around them with its vertices on the field's roots.
  Strays(const SparseGrid& grid, double farthest, const std::vector<Vec3>& positions,
         const std::vector<Triangle>& triangles, const CellSet& where, const ScalarFunction& field);
  /// Cells with a vertex that is so far or farther. @pre reach <= farthest
  std::vector<CellSet::Cell> farther_than(double reach) const;

 private:
  struct Place {
    Vec3 coordinates;  // in the grid
    double distance;   // m; infinite: more than the farthest
  };
  void measure(const SparseGrid& grid, double farthest, const std::vector<Vec3>& positions,
               const std::vector<Triangle>& triangles, const std::vector<Vec3>& other_positions,
               const std::vector<Triangle>& other_triangles, const CellSet* where);

  std::vector<Place> places_;
};

}  // namespace flowskin::tracking
