// Where a mesh and the sign of the field disagree. See docs/topology.md.
#pragma once

#include <vector>

#include "tracking/advection/projection.h"
#include "tracking/extraction/cell_set.h"
#include "tracking/field/implicit_field.h"
#include "tracking/mesh/surface_mesh.h"
#include "tracking/repair/grid_crossings.h"

namespace flowskin::tracking {

/// The cells of a grid in which the mesh says inside and the field outside, or the other way round, or in which the
/// mesh lies over itself. Looked at are the nodes of the grid, and the places between two crossings of the mesh on one
/// grid edge: so sheets closer to each other than a cell are seen, too. A place counts only where it is deeper than
/// `depth` (m) by |f| / |grad f|: triangles cut corners of a curved surface.
/// @param grid of the field
/// @param crossings of all triangles of the mesh
/// @param shallow cells with a place that is less deep are added
/// @pre The mesh is closed.
std::vector<CellSet::Cell> disagreeing_cells(const ImplicitField& field, const SparseGrid& grid, double depth,
                                             const GridCrossings& crossings,
                                             std::vector<CellSet::Cell>* shallow = nullptr);

/// The cells at grid edges that mesh and field cross at places farther from each other than `apart` (cells, below 1):
/// the mesh cuts off a ridge there, or bridges a groove, however shallow.
/// @param crossings of all triangles of the mesh, or of some
std::vector<CellSet::Cell> displaced_cells(const ImplicitField& field, const SparseGrid& grid, double apart,
                                           const GridCrossings& crossings);

/// The cells at grid edges that the mesh crosses more than once: marching cubes sees nothing of what is between.
/// @param crossings of all triangles of the mesh
std::vector<CellSet::Cell> hidden_cells(const GridCrossings& crossings);

}  // namespace flowskin::tracking
