#include "tracking/repair/places_to_mend.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/parallel.h"
#include "tracking/fairing/bad_triangles.h"
#include "tracking/fairing/relaxation.h"
#include "tracking/mesh/mesh_measures.h"
#include "tracking/mesh/self_intersections.h"
#include "tracking/repair/disagreement.h"
#include "tracking/repair/local_topology.h"
#include "tracking/repair/mesh_hole.h"
#include "tracking/repair/strays.h"

namespace flowskin::tracking {
namespace {

std::vector<Triangle> chosen(const std::vector<Triangle>& triangles, const std::vector<int>& numbers) {
  std::vector<Triangle> result(numbers.size());
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t i = 0; i < std::ssize(numbers); ++i) result[i] = triangles[numbers[i]];
  return result;
}

// Triangles that are off the surface, without area, or that intersect; and such as are wrong side out, but for fresh
// ones: a rim of fluid can be thinner than an edge, and the surface then folds sharply. `triangles` are those with the
// numbers `looked_at`.
std::vector<int> spoilt_triangles(const SurfaceMesh& mesh, const Projection& projection,
                                  const std::vector<int>& looked_at, const std::vector<Triangle>& triangles,
                                  bool are_fresh) {
  std::vector<char> failed(mesh.positions.size(), 0), spoilt(looked_at.size());
  for (int vertex : projection.failed) failed[vertex] = 1;
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t i = 0; i < std::ssize(looked_at); ++i) {
    const Triangle& triangle = triangles[i];
    spoilt[i] = failed[triangle[0]] || failed[triangle[1]] || failed[triangle[2]] ||
                is_degenerate(triangle, mesh.positions) ||
                (!are_fresh && is_inverted(triangle, mesh.positions, projection.normals));
  }
  for (const auto& [first, second] : self_intersections(mesh.positions, triangles)) spoilt[first] = spoilt[second] = 1;
  std::vector<int> found;
  for (std::size_t i = 0; i < looked_at.size(); ++i) {
    if (spoilt[i]) found.push_back(looked_at[i]);
  }
  return found;
}

// All triangles, or those that meet the cells.
std::vector<int> triangles_in(const CellSet* cells, const std::vector<Box>& boxes) {
  return where_true(boxes.size(), [&](int t) { return !cells || meets(*cells, boxes[t].min, boxes[t].max); });
}

// Narrow triangles where they are many among the triangles around them, as in the crease between bodies that have just
// met. What lies elsewhere has no say in it.
std::vector<int> crowded_narrow_triangles(const SurfaceMesh& mesh, const std::vector<Box>& boxes) {
  const std::vector<double> angles = smallest_angles(mesh.positions, mesh.triangles);
  const std::vector<int> narrow =
      where_true(angles.size(), [&](int t) { return angles[t] < kRepairLimits.narrow_angle; });
  if (narrow.empty()) return {};
  std::vector<CellSet::Cell> cells;
  for (int t : narrow) add_cells(boxes[t].min, boxes[t].max, cells);
  std::vector<int> crowded;
  for (const CellSet& around : CellSet(std::move(cells)).dilated(kRepairLimits.narrow_around).components()) {
    std::vector<int> within;
    for (int t : narrow) {
      if (meets(around, boxes[t].min, boxes[t].max)) within.push_back(t);
    }
    const auto count = static_cast<double>(triangles_in(&around, boxes).size());
    if (static_cast<double>(within.size()) >= kRepairLimits.many_narrow * count)
      crowded.insert(crowded.end(), within.begin(), within.end());
  }
  return crowded;
}

}  // namespace

std::vector<CellSet> PlacesToMend::find(const SurfaceMesh& mesh, const Projection& projection) {
  const std::vector<Box> boxes = boxes_of(fresh_.grid, mesh);
  const std::vector<int> looked_at = triangles_in(focus_ ? &*focus_ : nullptr, boxes);
  const std::vector<Triangle> triangles = chosen(mesh.triangles, looked_at);
  std::vector<CellSet::Cell> cells = disagreements(mesh, triangles);
  std::vector<int> spoilt = spoilt_triangles(mesh, projection, looked_at, triangles, focus_.has_value());
  if (!focus_) {
    const std::vector<int> narrow = crowded_narrow_triangles(mesh, boxes);
    spoilt.insert(spoilt.end(), narrow.begin(), narrow.end());
  }
  for (int t : spoilt) add_cells(boxes[t].min, boxes[t].max, cells);
  std::erase_if(cells, [&](const CellSet::Cell& cell) { return named_[kTimes - 1].contains(cell); });
  return regions(widened_where_named_again(CellSet(std::move(cells))));
}

std::vector<CellSet::Cell> PlacesToMend::disagreements(const SurfaceMesh& mesh,
                                                       const std::vector<Triangle>& looked_at) const {
  const GridCrossings crossings = grid_crossings(fresh_.grid, mesh.positions, looked_at);
  std::vector<CellSet::Cell> cells,
      doubtful = displaced_cells(fresh_.field, fresh_.grid, kRepairLimits.doubtful_crossing, crossings);
  const auto doubt = [&](const std::vector<CellSet::Cell>& more) {
    doubtful.insert(doubtful.end(), more.begin(), more.end());
  };
  const double far = kRepairLimits.doubtful_distance * fresh_.grid.spacing();
  // Fresh surface agrees with the signs of the grid.
  if (!focus_) {
    cells = disagreeing_cells(fresh_.field, fresh_.grid, depth_, crossings, &doubtful);
    doubt(far_centers(fresh_.grid, far, expected_, ClosestPointTree(mesh.positions, mesh.triangles)));
  }
  doubt(far_from_grid_surface(fresh_.grid, far, mesh.positions, looked_at, expected_tree_));
  for (const auto& cell : strays_in(CellSet(std::move(doubtful)), mesh)) cells.push_back(cell);
  return cells;
}

// Of these places, those where only one of the surfaces has a part, or it lies elsewhere.
std::vector<CellSet::Cell> PlacesToMend::strays_in(const CellSet& places, const SurfaceMesh& mesh) const {
  const double reach = kRepairLimits.too_far_apart * fresh_.grid.spacing();
  const auto value = [&](const Vec3& x) { return fresh_.field.value(x); };
  return stray_cells(fresh_.grid, reach, mesh.positions, mesh.triangles, places, value);
}

CellSet PlacesToMend::widened_where_named_again(const CellSet& named) {
  CellSet widened = named;
  for (int k = kTimes - 1; k >= 0; --k) {
    // Named k + 1 times before.
    std::vector<CellSet::Cell> again;
    for (const auto& cell : named.cells()) {
      if (named_[k].contains(cell)) again.push_back(cell);
    }
    const CellSet set(std::move(again));
    if (k + 1 < kTimes) named_[k + 1] = named_[k + 1].united(set);
    widened = widened.united(set.dilated(1 + k));
  }
  named_[0] = named_[0].united(named);
  return widened;
}

std::vector<CellSet> PlacesToMend::find_strays(const SurfaceMesh& mesh) {
  if (stray_round_ == std::ssize(kRepairLimits.stray_distances)) return {};
  const double spacing = fresh_.grid.spacing();
  const Strays strays(fresh_.grid, kRepairLimits.stray_distances[stray_round_] * spacing,
                      {mesh.positions, mesh.triangles}, expected_);
  while (stray_round_ < std::ssize(kRepairLimits.stray_distances)) {
    const CellSet cells(strays.farther_than(kRepairLimits.stray_distances[stray_round_++] * spacing));
    if (!cells.empty()) return regions(cells.dilated(1));
  }
  return {};
}

std::vector<CellSet> PlacesToMend::find_hidden(const SurfaceMesh& mesh) {
  if (hidden_round_ == std::ssize(kRepairLimits.hidden_angles)) return {};
  const GridCrossings crossings = grid_crossings(fresh_.grid, mesh.positions, mesh.triangles);
  std::vector<CellSet::Cell> hidden_or_shallow = hidden_cells(crossings);
  for (const auto& cell : disagreeing_cells(fresh_.field, fresh_.grid, 0, crossings)) hidden_or_shallow.push_back(cell);
  const CellSet hidden = CellSet(std::move(hidden_or_shallow)).dilated(1);
  const LocalTopology topology(fresh_.grid, mesh.positions, mesh.triangles, expected_);
  while (hidden_round_ < std::ssize(kRepairLimits.hidden_angles)) {
    const CellSet cells(topology.differing(hidden, kRepairLimits.hidden_angles[hidden_round_++]));
    if (!cells.empty()) return regions(cells.dilated(1));
  }
  return {};
}

std::vector<CellSet> PlacesToMend::regions(const CellSet& places) {
  focus_ = places.dilated(kRepairLimits.looked_at_again);
  return places.components();
}

}  // namespace flowskin::tracking
