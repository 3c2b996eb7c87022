// Marching cubes on a sparse grid.
#pragma once

#include <functional>
#include <vector>

#include "tracking/extraction/cell_set.h"
#include "tracking/extraction/sparse_grid.h"
#include "tracking/mesh/surface_mesh.h"

namespace flowskin::tracking {

/// A surface without attributes. Triangles counter-clockwise seen from outside.
struct SurfaceGeometry {
  std::vector<Vec3> positions;  ///< m
  std::vector<Triangle> triangles;
};

/// A scalar function of the place; positive inside. Called from many threads.
using ScalarFunction = std::function<double(const Vec3&)>;

/// The surface that parts nodes with positive values (inside) from the others. Closed, two-manifold, consistently
/// oriented and without unreferenced vertices for any values, as long as the outside value is not positive and no
/// inside node lies on the border of the blocks. The order of vertices and triangles depends on the values only.
/// @param field Where given, each vertex is put on its root along the grid edge (regula falsi, Illinois variant, to a
///   millionth of the spacing); else on the root of linear interpolation. Vertices keep a distance of 1e-3 spacings
///   from the nodes, so that no two of them coincide even where nodes are exact zeros.
SurfaceGeometry march(const SparseGrid& grid, const ScalarFunction& field = nullptr);

/// The same surface within some cells only: open where it leaves them. Triangles in the order of the cells.
SurfaceGeometry march(const SparseGrid& grid, const CellSet& cells, const ScalarFunction& field = nullptr);

/// Puts a vertex of a surface that march() has made without the field on the field's root, as with it.
void put_on_root(const SparseGrid& grid, const ScalarFunction& field, Vec3& position);

}  // namespace flowskin::tracking
