#include "tracking/repair/disagreement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tracking/repair/grid_crossings.h"

namespace flowskin::tracking {
namespace {

using Cell = CellSet::Cell;

constexpr double kSurelyNear = 0.5;  // of the distance allowed: the field is no parabola between two nodes

// A place to be looked at, in grid coordinates, with the winding number of the mesh there.
struct Probe {
  Vec3 coordinates;
  int winding;
};

// Grid coordinates of a place on a line along an axis; of a node where the place is a whole number.
template <class Coordinates, class Place>
Coordinates on_line(const std::array<int, 2>& line, int axis, Place place) {
  Coordinates coordinates{};
  coordinates[axis] = place;
  coordinates[(axis + 1) % 3] = line[0];
  coordinates[(axis + 2) % 3] = line[1];
  return coordinates;
}

// All cells that it lies in or on.
void add_cells_around(const Probe& probe, std::vector<Cell>& cells) {
  add_cells(probe.coordinates.array().ceil() - 1, probe.coordinates.array().floor(), cells);
}

// Of lines along one axis: places between crossings that lie on the same grid edge.
void probe_edges(const std::vector<GridCrossing>& crossings, int axis, std::vector<Probe>& probes) {
  for_each_line(crossings, [&](const GridCrossing* begin, const GridCrossing* end) {
    int winding = 0;
    for (const GridCrossing* crossing = begin; crossing + 1 < end; ++crossing) {
      winding += crossing->change;
      if (std::floor(crossing->place) != std::floor(crossing[1].place)) continue;
      probes.push_back({on_line<Vec3>(crossing->line, axis, (crossing->place + crossing[1].place) / 2), winding});
    }
  });
}

// Where between 0 and 1 a parabola is zero that is f at 0 and g at 1, of the other sign, and has this second
// difference.
double root_of_parabola(double f, double g, double second_difference) {
  const double a = second_difference / 2, b = g - f - a;
  const double q = -(b + std::copysign(std::sqrt(std::max(0.0, b * b - 4 * a * f)), b)) / 2;
  const double root = f / q;
  return root >= 0 && root <= 1 ? root : q / a;
}

// May the field's zero on the grid edge of a crossing be farther from it than `apart` (cells)? It is surely near
// where that is so with a straight line between the values at the edge's ends, and with the parabolas through the nodes
// before and behind it.
bool may_be_displaced(const SparseGrid& grid, const GridCrossing& crossing, int axis, double apart) {
  const int low = static_cast<int>(std::floor(crossing.place));
  const auto value = [&](int place) { return grid.value(on_line<SparseGrid::Index>(crossing.line, axis, place)); };
  const double f = value(low), g = value(low + 1);
  if ((f > 0) == (g > 0)) return false;
  return std::ranges::any_of(
      std::array{0.0, value(low - 1) - 2 * f + g, f - 2 * g + value(low + 2)}, [&](double second) {
        return std::abs(low + root_of_parabola(f, g, second) - crossing.place) >= kSurelyNear * apart;
      });
}

// Of lines along one axis: places `apart` (cells) to both sides of a crossing that is alone on its grid edge, where the
// values of the grid do not show that the field's zero is nearer.
void probe_beside(const SparseGrid& grid, const std::vector<GridCrossing>& crossings, int axis, double apart,
                  std::vector<Probe>& probes) {
  for_each_line(crossings, [&](const GridCrossing* begin, const GridCrossing* end) {
    for (const GridCrossing* crossing = begin; crossing < end; ++crossing) {
      const double low = std::floor(crossing->place);
      if ((crossing > begin && crossing[-1].place >= low) || (crossing + 1 < end && crossing[1].place < low + 1))
        continue;
      if (!may_be_displaced(grid, *crossing, axis, apart)) continue;
      for (const int side : {-1, 1}) {
        const double place = crossing->place + side * apart;
        if (place <= low || place >= low + 1) continue;
        probes.push_back({on_line<Vec3>(crossing->line, axis, place), side * crossing->change > 0 ? 1 : 0});
      }
    }
  });
}

// The crossings of lines along z, by line.
class Columns {
 public:
  explicit Columns(const std::vector<GridCrossing>& crossings) {
    for_each_line(crossings, [&](const GridCrossing* begin, const GridCrossing* end) {
      lines_.push_back({begin->line, begin, end});
    });
  }

  // Calls visit(k, winding) for the nodes first to last of a line.
  template <class Visit>
  void walk(const std::array<int, 2>& line, int first, int last, const Visit& visit) const {
    const auto found = std::lower_bound(lines_.begin(), lines_.end(), line,
                                        [](const Line& a, const std::array<int, 2>& b) { return a.line < b; });
    const bool known = found != lines_.end() && found->line == line;
    const GridCrossing* next = known ? found->begin : nullptr;
    const GridCrossing* end = known ? found->end : nullptr;
    int winding = 0;
    for (int k = first; k <= last; ++k) {
      for (; next != end && next->place < k; ++next) winding += next->change;
      visit(k, winding);
    }
  }

 private:
  struct Line {
    std::array<int, 2> line;
    const GridCrossing *begin, *end;
  };
  std::vector<Line> lines_;
};

// Nodes whose winding number and value do not agree.
std::vector<Probe> probe_nodes(const SparseGrid& grid, const std::vector<GridCrossing>& crossings) {
  constexpr int side = SparseGrid::kSide;
  const Columns columns(crossings);
  const int count = static_cast<int>(grid.blocks().size());
  std::vector<std::vector<Probe>> of_block(count);
#pragma omp parallel for schedule(dynamic, 16)
  for (int b = 0; b < count; ++b) {
    const SparseGrid::Block& block = grid.blocks()[b];
    const Cell first = {side * block.place[0], side * block.place[1], side * block.place[2]};
    for (int i = 0; i < side; ++i) {
      for (int j = 0; j < side; ++j) {
        const double* values = block.values.data() + SparseGrid::node_in_block(i, j, 0);
        columns.walk({first[0] + i, first[1] + j}, first[2], first[2] + side - 1, [&](int k, int winding) {
          if (winding == (values[k - first[2]] > 0 ? 1 : 0)) return;
          of_block[b].push_back({Vec3(first[0] + i, first[1] + j, k), winding});
        });
      }
    }
  }
  std::vector<Probe> probes;
  for (const auto& found : of_block) probes.insert(probes.end(), found.begin(), found.end());
  return probes;
}

// |f| / |grad f| (m) at the probes where mesh and field do not agree which side they are on; -1 at the others.
std::vector<double> depths_on_wrong_side(const ImplicitField& field, const SparseGrid& grid,
                                         const std::vector<Probe>& probes) {
  std::vector<double> depths(probes.size(), -1);
#pragma omp parallel for schedule(dynamic, 64)
  for (int p = 0; p < static_cast<int>(probes.size()); ++p) {
    const Vec3 x = grid.position({0, 0, 0}) + grid.spacing() * probes[p].coordinates;
    Vec3 gradient;
    const double f = field.value(x, gradient);
    if (probes[p].winding == (f > 0 ? 1 : 0)) continue;
    const double slope = gradient.norm();
    depths[p] = slope > 0 ? std::abs(f) / slope : std::numeric_limits<double>::infinity();
  }
  return depths;
}

}  // namespace

std::vector<Cell> disagreeing_cells(const ImplicitField& field, const SparseGrid& grid, double depth,
                                    const GridCrossings& crossings, std::vector<Cell>* shallow) {
  std::vector<Probe> probes = probe_nodes(grid, crossings[2]);
  for (int axis = 0; axis < 3; ++axis) probe_edges(crossings[axis], axis, probes);
  const std::vector<double> depths = depths_on_wrong_side(field, grid, probes);
  std::vector<Cell> cells;
  for (std::size_t p = 0; p < probes.size(); ++p) {
    if (depths[p] < 0) continue;
    const bool covered_twice = probes[p].winding < 0 || probes[p].winding > 1;
    const bool deep = covered_twice || depths[p] > depth;
    if (deep || shallow) add_cells_around(probes[p], deep ? cells : *shallow);
  }
  return cells;
}

std::vector<Cell> displaced_cells(const ImplicitField& field, const SparseGrid& grid, double apart,
                                  const GridCrossings& crossings) {
  std::vector<Probe> probes;
  for (int axis = 0; axis < 3; ++axis) probe_beside(grid, crossings[axis], axis, apart, probes);
  const std::vector<double> depths = depths_on_wrong_side(field, grid, probes);
  std::vector<Cell> cells;
  for (std::size_t p = 0; p < probes.size(); ++p) {
    if (depths[p] >= 0) add_cells_around(probes[p], cells);
  }
  return cells;
}

std::vector<Cell> hidden_cells(const GridCrossings& crossings) {
  std::vector<Probe> probes;
  for (int axis = 0; axis < 3; ++axis) probe_edges(crossings[axis], axis, probes);
  std::vector<Cell> cells;
  for (const Probe& probe : probes) add_cells_around(probe, cells);
  return cells;
}

}  // namespace flowskin::tracking
