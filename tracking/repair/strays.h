// Where one of two surfaces has a part that the other lacks.
#pragma once

#include <vector>

#include "common/closest_point.h"
#include "tracking/extraction/cell_set.h"
#include "tracking/extraction/marching_cubes.h"

namespace flowskin::tracking {

/// How far vertices and triangle centres of two surfaces are from the other surface, as far as that looks the same way
/// (at most 60 degrees off). For features below the size of a cell, which the nodes of a grid do not see.
class Strays {
 public:
  /// @param farthest distances are measured up to here (m)
  Strays(const SparseGrid& grid, double farthest, const SurfaceGeometry& mesh, const SurfaceGeometry& fresh);
  /// Cells with a place that is so far or farther. @pre reach <= farthest
  std::vector<CellSet::Cell> farther_than(double reach) const;

 private:
  struct Place {
    Vec3 coordinates;  // in the grid
    double distance;   // m; infinite: more than the farthest
  };
  void measure(const SparseGrid& grid, double farthest, const SurfaceGeometry& surface, const SurfaceGeometry& other);

  std::vector<Place> places_;
};

/// The cells with centres of triangles that are farther than `reach` (m) from another surface, whichever way that
/// looks.
std::vector<CellSet::Cell> far_centers(const SparseGrid& grid, double reach, const SurfaceGeometry& surface,
                                       const ClosestPointTree& other);

/// The cells with vertices or centres of triangles that are farther than `reach` (m) from the surface that march()
/// makes of the grid's values.
std::vector<CellSet::Cell> far_from_grid_surface(const SparseGrid& grid, double reach,
                                                 const std::vector<Vec3>& positions,
                                                 const std::vector<Triangle>& triangles,
                                                 const ClosestPointTree& grid_surface);

/// Of some cells those with a vertex or triangle centre that is farther than `reach` (m) from
/// the other surface. The fresh surface has its vertices on the field's roots.
std::vector<CellSet::Cell> stray_cells(const SparseGrid& grid, double reach, const std::vector<Vec3>& positions,
                                       const std::vector<Triangle>& triangles, const CellSet& where,
                                       const ScalarFunction& field);

}  // namespace flowskin::tracking
