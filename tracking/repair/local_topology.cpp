#include "tracking/repair/local_topology.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tracking/mesh/editable_mesh.h"
#include "tracking/repair/repair_limits.h"

namespace flowskin::tracking {
namespace {}  // namespace

LocalTopology::LocalTopology(const SparseGrid& grid, const std::vector<Vec3>& positions,
                             const std::vector<Triangle>& triangles, const SurfaceGeometry& fresh) {
  add(grid, 1, positions, triangles);
  add(grid, -1, fresh.positions, fresh.triangles);
  std::stable_sort(defects_.begin(), defects_.end(), [](const Defect& a, const Defect& b) { return a.cell < b.cell; });
  std::vector<Defect> merged;
  for (const Defect& defect : defects_) {
    if (merged.empty() || merged.back().cell != defect.cell) {
      merged.push_back(defect);
    } else {
      merged.back().sum += defect.sum;
    }
  }
  defects_ = std::move(merged);
}

void LocalTopology::add(const SparseGrid& grid, double sign, const std::vector<Vec3>& positions,
                        const std::vector<Triangle>& triangles) {
  std::vector<double> missing(positions.size(), 2 * std::numbers::pi);
  for (const Triangle& triangle : triangles) {
    for (int corner = 0; corner < 3; ++corner) {
      missing[triangle[corner]] -= angle_at(positions[triangle[corner]], positions[triangle[(corner + 1) % 3]],
                                            positions[triangle[(corner + 2) % 3]]);
    }
  }
  for (std::size_t v = 0; v < positions.size(); ++v) {
    defects_.push_back({cell_at(grid.coordinates(positions[v])), sign * missing[v]});
  }
}

std::vector<CellSet::Cell> LocalTopology::differing(const CellSet& where, double share) const {
  const double limit = share * 4 * std::numbers::pi;
  std::vector<char> differs(where.cells().size());
#pragma omp parallel for schedule(dynamic, 64)
  for (std::ptrdiff_t i = 0; i < std::ssize(differs); ++i) {
    const CellSet::Cell& center = where.cells()[i];
    double sum = 0;
    for (int dx = -kRepairLimits.hidden_window; dx <= kRepairLimits.hidden_window; ++dx) {
      for (int dy = -kRepairLimits.hidden_window; dy <= kRepairLimits.hidden_window; ++dy) {
        const CellSet::Cell first = {center[0] + dx, center[1] + dy, center[2] - kRepairLimits.hidden_window};
        auto next =
            std::lower_bound(defects_.begin(), defects_.end(), first,
                             [](const Defect& defect, const CellSet::Cell& cell) { return defect.cell < cell; });
        const CellSet::Cell last = {first[0], first[1], center[2] + kRepairLimits.hidden_window};
        for (; next != defects_.end() && next->cell <= last; ++next) sum += next->sum;
      }
    }
    differs[i] = std::abs(sum) > limit;
  }
  std::vector<CellSet::Cell> found;
  for (std::size_t i = 0; i < differs.size(); ++i) {
    if (differs[i]) found.push_back(where.cells()[i]);
  }
  return found;
}

}  // namespace flowskin::tracking
