// Where a mesh is to be mended, round after round.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "common/closest_point.h"
#include "tracking/advection/projection.h"
#include "tracking/extraction/cell_set.h"
#include "tracking/extraction/marching_cubes.h"
#include "tracking/mesh/surface_mesh.h"
#include "tracking/repair/repair_limits.h"
#include "tracking/repair/replace_region.h"

namespace flowskin::tracking {

/// Finds the regions of a mesh in which it and the field disagree, or its triangles are spoilt. Each round looks at the
/// places that the one before has named, and around them; the first one looks everywhere.
class PlacesToMend {
 public:
  /// Keeps references.
  /// @param expected what marching cubes makes of the grid, by linear interpolation
  /// @param depth disagreements less deep than this (m) are let pass
  PlacesToMend(const FieldGrid& fresh, const SurfaceGeometry& expected, double depth)
      : fresh_(fresh), expected_(expected), expected_tree_(expected.positions, expected.triangles), depth_(depth) {}

  /// The regions with something to mend. What is still spoilt when it has been replaced is replaced in wider and wider
  /// regions, and in the end left as it is.
  std::vector<CellSet> find(const SurfaceMesh& mesh, const Projection& projection);

  /// Parts that only one of the two surfaces has; looked for more and more closely.
  std::vector<CellSet> find_strays(const SurfaceMesh& mesh);

  /// Holes and bridges in films, threads and gaps thinner than a cell: the field may have them or not, marching cubes
  /// does not see it.
  std::vector<CellSet> find_hidden(const SurfaceMesh& mesh);

 private:
  std::vector<CellSet::Cell> disagreements(const SurfaceMesh& mesh, const std::vector<Triangle>& looked_at) const;
  std::vector<CellSet::Cell> strays_in(const CellSet& places, const SurfaceMesh& mesh) const;
  CellSet widened_where_named_again(const CellSet& named);
  std::vector<CellSet> regions(const CellSet& places);

  static constexpr int kTimes = kRepairLimits.times_marked;

  const FieldGrid& fresh_;
  const SurfaceGeometry& expected_;
  ClosestPointTree expected_tree_;
  double depth_;
  std::array<CellSet, kTimes> named_;  // cells that have been named once, twice ...
  std::optional<CellSet> focus_;       // none: everywhere
  int stray_round_ = 0, hidden_round_ = 0;
};

}  // namespace flowskin::tracking
