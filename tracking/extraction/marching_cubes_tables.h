// The triangles of each of the 256 sign patterns of a cell, made from a rule for its faces.
#pragma once

#include <array>
#include <vector>

namespace flowskin::tracking {

/// Corner c of a cell has the coordinates (c & 1, c >> 1 & 1, c >> 2 & 1).
/// Edge 4 a + u + 2 v runs along axis a from the corner with coordinate u along axis a + 1 and v along axis a + 2.
struct CellTables {
  /// Triangles, as edges of the cell, counter-clockwise seen from outside.
  using Triangles = std::vector<std::array<int, 3>>;
  /// All ways to cut the polygons of a pattern into triangles; at least one, even if of no triangles. Bit c of the
  /// pattern: corner c is inside.
  std::array<std::vector<Triangles>, 256> triangulations;
  std::array<std::array<int, 2>, 12> edge_corners;  ///< The two ends of an edge, the lower corner first.
};

/// Each face is cut by itself: every run of inside corners along its border is cut off by one segment, so that inside
/// corners which only touch along a diagonal stay apart. The rule sees nothing but the four signs, so both cells of a
/// face cut it alike and the surface is closed. Segments join to polygons; polygons are cut into triangles by diagonals
/// that never lie in a face of the cell, because there the neighbour could have the same one: no edge has more than two
/// triangles.
const CellTables& cell_tables();

}  // namespace flowskin::tracking
