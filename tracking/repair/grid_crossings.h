// Where the lines of a grid pass through a mesh, and how often the mesh winds around the nodes.
#pragma once

#include <array>
#include <vector>

#include "tracking/extraction/sparse_grid.h"
#include "tracking/mesh/surface_mesh.h"

namespace flowskin::tracking {

/// A grid line along axis a passes through a triangle.
struct GridCrossing {
  std::array<int, 2> line;  ///< Grid coordinates of the line along the axes a + 1 and a + 2.
  double place;             ///< Grid coordinate along a.
  int triangle;
  int change;  ///< Of the winding number towards higher coordinates: 1 where the line enters the mesh, -1 where it
               ///< leaves.
};

/// Crossings of the lines along one axis, sorted by line, then place. Every line leaves a closed mesh as often as it
/// enters it, even where it passes exactly through an edge or a vertex: lines are treated as if they were shifted by
/// an infinitesimal amount (Edelsbrunner and Muecke 1990).
std::vector<GridCrossing> grid_crossings(const SparseGrid& grid, int axis, const std::vector<Vec3>& positions,
                                         const std::vector<Triangle>& triangles);

/// Of the lines along each axis.
using GridCrossings = std::array<std::vector<GridCrossing>, 3>;
GridCrossings grid_crossings(const SparseGrid& grid, const std::vector<Vec3>& positions,
                             const std::vector<Triangle>& triangles);

/// Calls visit(line of crossings: begin, end) for each line that has any.
template <class Visit>
void for_each_line(const std::vector<GridCrossing>& crossings, const Visit& visit) {
  for (std::size_t begin = 0, end = 0; begin < crossings.size(); begin = end) {
    while (end < crossings.size() && crossings[end].line == crossings[begin].line) ++end;
    visit(crossings.data() + begin, crossings.data() + end);
  }
}

}  // namespace flowskin::tracking
