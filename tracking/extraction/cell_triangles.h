// The triangles of one cell of marching cubes.
#pragma once

#include "tracking/extraction/marching_cubes_tables.h"
#include "tracking/particles.h"

namespace flowskin::tracking {

/// The first triangulation of a pattern in which no two triangles intersect, where the vertices on the cell's edges are
/// at these places; the first of all where each has some that do. Polygons of a cell can be far from flat, and a fixed
/// way to cut them then folds over; the triangles of different cells never intersect.
/// @param places only those of edges whose ends are on different sides are looked at
const CellTables::Triangles& triangles_of_cell(int pattern, const std::array<Vec3, 12>& places);

}  // namespace flowskin::tracking
