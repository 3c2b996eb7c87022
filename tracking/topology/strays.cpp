#include "tracking/topology/strays.h"

#include <cmath>
#include <limits>

#include "tracking/mesh/closest_point.h"
#include "tracking/mesh/mesh_measures.h"
#include "tracking/topology/where_true.h"

namespace flowskin::tracking {
namespace {

constexpr double kSameSide = 0.5;

std::vector<Triangle> triangles_in(const CellSet& cells, const SparseGrid& grid, const std::vector<Vec3>& positions,
                                   const std::vector<Triangle>& triangles) {
  std::vector<Triangle> found;
  for (int t : where_true(triangles.size(), [&](int i) {
         const Vec3 x = grid.coordinates(positions[triangles[i][0]]);
         return meets(cells, x, x);
       }))
    found.push_back(triangles[t]);
  return found;
}

}  // namespace

Strays::Strays(const SparseGrid& grid, double farthest, const std::vector<Vec3>& positions,
               const std::vector<Triangle>& triangles, const SurfaceGeometry& fresh) {
  measure(grid, farthest, positions, triangles, fresh.positions, fresh.triangles, nullptr);
  measure(grid, farthest, fresh.positions, fresh.triangles, positions, triangles, nullptr);
}

Strays::Strays(const SparseGrid& grid, double farthest, const std::vector<Vec3>& positions,
               const std::vector<Triangle>& triangles, const CellSet& where, const ScalarFunction& field) {
  if (where.empty()) return;
  // Whatever may be near enough or bear on the normals.
  const int layers = static_cast<int>(std::ceil(farthest / grid.spacing()));
  const SurfaceGeometry fresh = march(grid, where.dilated(layers), field);
  const std::vector<Triangle> near = triangles_in(where.dilated(1 + layers), grid, positions, triangles);
  measure(grid, farthest, positions, near, fresh.positions, fresh.triangles, &where);
  measure(grid, farthest, fresh.positions, fresh.triangles, positions, near, &where);
}

void Strays::measure(const SparseGrid& grid, double farthest, const std::vector<Vec3>& positions,
                     const std::vector<Triangle>& triangles, const std::vector<Vec3>& other_positions,
                     const std::vector<Triangle>& other_triangles, const CellSet* where) {
  const std::vector<int> vertices = where_true(positions.size(), [&](int v) {
    const Vec3 x = grid.coordinates(positions[v]);
    return !where || meets(*where, x, x);
  });
  const ClosestPointTree other(other_positions, other_triangles);
  const std::vector<Vec3> normals = vertex_normals(positions, triangles);
  const std::size_t first = places_.size();
  places_.resize(first + vertices.size());
#pragma omp parallel for schedule(dynamic, 256)
  for (int i = 0; i < static_cast<int>(vertices.size()); ++i) {
    const int v = vertices[i];
    const MeshPoint point = other.closest(positions[v], farthest, normals[v], kSameSide);
    places_[first + i] = {grid.coordinates(positions[v]),
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
