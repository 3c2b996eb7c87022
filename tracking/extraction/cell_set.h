// A set of grid cells: a region of space.
#pragma once

#include <vector>

#include "tracking/extraction/sparse_grid.h"

namespace flowskin::tracking {

/// Cells in lexicographic order. A cell is named by its lowest node; it reaches from there to the next node along each
/// axis.
class CellSet {
 public:
  using Cell = SparseGrid::Index;

  CellSet() = default;
  /// In any order, each as often as one likes.
  explicit CellSet(std::vector<Cell> cells);

  const std::vector<Cell>& cells() const { return cells_; }
  bool empty() const { return cells_.empty(); }
  bool contains(const Cell& cell) const;
  bool contains(const CellSet& other) const;
  /// Lowest and highest cell along each axis. @pre not empty
  const Cell& low() const { return low_; }
  const Cell& high() const { return high_; }

  CellSet united(const CellSet& other) const;
  /// With all cells at most so many away along each axis.
  CellSet dilated(int layers) const;
  /// The parts that hang together over faces, edges or corners, by their lowest cell.
  std::vector<CellSet> components() const;

 private:
  CellSet moved(int axis, int offset) const;

  std::vector<Cell> cells_;
  Cell low_{}, high_{};
};

/// The cell that a place in grid coordinates lies in.
CellSet::Cell cell_at(const Vec3& coordinates);

/// Whether a box in grid coordinates (see SparseGrid::coordinates) meets one of the cells.
bool meets(const CellSet& cells, const Vec3& low, const Vec3& high);

/// The cells that a box in grid coordinates meets are added.
void add_cells(const Vec3& low, const Vec3& high, std::vector<CellSet::Cell>& cells);

}  // namespace flowskin::tracking
