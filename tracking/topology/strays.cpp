#include "tracking/topology/strays.h"

#include <limits>

#include "tracking/mesh/closest_point.h"
#include "tracking/mesh/mesh_measures.h"

namespace flowskin::tracking {
namespace {

constexpr double kSameSide = 0.5;

}  // namespace

Strays::Strays(const SparseGrid& grid, double farthest, const std::vector<Vec3>& positions,
               const std::vector<Triangle>& triangles, const SurfaceGeometry& fresh) {
  measure(grid, farthest, positions, triangles, fresh.positions, fresh.triangles);
  measure(grid, farthest, fresh.positions, fresh.triangles, positions, triangles);
}

void Strays::measure(const SparseGrid& grid, double farthest, const std::vector<Vec3>& positions,
                     const std::vector<Triangle>& triangles, const std::vector<Vec3>& other_positions,
                     const std::vector<Triangle>& other_triangles) {
  const ClosestPointTree other(other_positions, other_triangles);
  const std::vector<Vec3> normals = vertex_normals(positions, triangles);
  const std::size_t first = places_.size();
  places_.resize(first + positions.size());
#pragma omp parallel for schedule(dynamic, 256)
  for (int v = 0; v < static_cast<int>(positions.size()); ++v) {
    const MeshPoint point = other.closest(positions[v], farthest, normals[v], kSameSide);
    places_[first + v] = {grid.coordinates(positions[v]),
                          point.triangle < 0 ? std::numeric_limits<double>::infinity() : point.distance};
  }
}

std::vector<CellSet::Cell> Strays::farther_than(double reach) const {
  std::vector<CellSet::Cell> cells;
  for (const Place& place : places_) {
    if (!(place.distance < reach)) add_cells(place.coordinates, place.coordinates, cells);
  }
  return cells;
}

}  // namespace flowskin::tracking
