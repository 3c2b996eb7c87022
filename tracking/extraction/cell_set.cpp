#include "tracking/extraction/cell_set.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace flowskin::tracking {
namespace {

using Cell = CellSet::Cell;

template <class Visit>
void for_each_cell(const Cell& low, const Cell& high, const Visit& visit) {
  for (int i = low[0]; i <= high[0]; ++i) {
    for (int j = low[1]; j <= high[1]; ++j) {
      for (int k = low[2]; k <= high[2]; ++k) visit(Cell{i, j, k});
    }
  }
}

}  // namespace

Cell cell_at(const Vec3& coordinates) {
  return {static_cast<int>(std::floor(coordinates[0])), static_cast<int>(std::floor(coordinates[1])),
          static_cast<int>(std::floor(coordinates[2]))};
}

CellSet::CellSet(std::vector<Cell> cells) : cells_(std::move(cells)) {
  std::sort(cells_.begin(), cells_.end());
  cells_.erase(std::unique(cells_.begin(), cells_.end()), cells_.end());
  if (cells_.empty()) return;
  low_ = high_ = cells_.front();
  for (const Cell& cell : cells_) {
    for (int axis = 0; axis < 3; ++axis) {
      low_[axis] = std::min(low_[axis], cell[axis]);
      high_[axis] = std::max(high_[axis], cell[axis]);
    }
  }
}

bool CellSet::contains(const Cell& cell) const { return std::binary_search(cells_.begin(), cells_.end(), cell); }

bool CellSet::contains(const CellSet& other) const {
  return std::includes(cells_.begin(), cells_.end(), other.cells_.begin(), other.cells_.end());
}

CellSet CellSet::united(const CellSet& other) const {
  if (other.empty()) return *this;
  if (empty()) return other;
  CellSet sum;
  sum.cells_.reserve(cells_.size() + other.cells_.size());
  std::set_union(cells_.begin(), cells_.end(), other.cells_.begin(), other.cells_.end(),
                 std::back_inserter(sum.cells_));
  for (int axis = 0; axis < 3; ++axis) {
    sum.low_[axis] = std::min(low_[axis], other.low_[axis]);
    sum.high_[axis] = std::max(high_[axis], other.high_[axis]);
  }
  return sum;
}

CellSet CellSet::moved(int axis, int offset) const {
  CellSet result = *this;
  for (Cell& cell : result.cells_) cell[axis] += offset;
  result.low_[axis] += offset;
  result.high_[axis] += offset;
  return result;
}

CellSet CellSet::dilated(int layers) const {
  CellSet grown = *this;
  // A union of two sets that are moved against each other by less than they are long leaves no gaps.
  for (int axis = 0; axis < 3; ++axis) {
    int left = 2 * layers;
    for (int length = 1; left > 0; left -= std::min(left, length), length *= 2)
      grown = grown.united(grown.moved(axis, std::min(left, length)));
    grown = grown.moved(axis, -layers);
  }
  return grown;
}

std::vector<CellSet> CellSet::components() const {
  std::vector<CellSet> parts;
  std::vector<char> reached(cells_.size());
  for (std::size_t first = 0; first < cells_.size(); ++first) {
    if (reached[first]) continue;
    reached[first] = 1;
    std::vector<std::size_t> open{first};
    std::vector<Cell> part;
    while (!open.empty()) {
      const Cell cell = cells_[open.back()];
      open.pop_back();
      part.push_back(cell);
      for_each_cell({cell[0] - 1, cell[1] - 1, cell[2] - 1}, {cell[0] + 1, cell[1] + 1, cell[2] + 1},
                    [&](const Cell& next) {
                      const auto found = std::lower_bound(cells_.begin(), cells_.end(), next);
                      const auto index = static_cast<std::size_t>(found - cells_.begin());
                      if (found == cells_.end() || *found != next || reached[index]) return;
                      reached[index] = 1;
                      open.push_back(index);
                    });
    }
    parts.emplace_back(std::move(part));
  }
  return parts;
}

bool meets(const CellSet& cells, const Vec3& low, const Vec3& high) {
  if (cells.empty()) return false;
  Cell first = cell_at(low), last = cell_at(high);
  for (int axis = 0; axis < 3; ++axis) {
    first[axis] = std::max(first[axis], cells.low()[axis]);
    last[axis] = std::min(last[axis], cells.high()[axis]);
    if (first[axis] > last[axis]) return false;
  }
  for (Cell cell = first; cell[0] <= last[0]; ++cell[0]) {
    for (cell[1] = first[1]; cell[1] <= last[1]; ++cell[1]) {
      cell[2] = first[2];
      const auto next = std::lower_bound(cells.cells().begin(), cells.cells().end(), cell);
      cell[2] = last[2];
      if (next != cells.cells().end() && *next <= cell) return true;
    }
  }
  return false;
}

void add_cells(const Vec3& low, const Vec3& high, std::vector<Cell>& cells) {
  for_each_cell(cell_at(low), cell_at(high), [&](const Cell& cell) { cells.push_back(cell); });
}

}  // namespace flowskin::tracking
