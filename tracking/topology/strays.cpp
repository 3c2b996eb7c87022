#include "tracking/topology/strays.h"

#include <cmath>
#include <limits>

#include "tracking/mesh/mesh_measures.h"
#include "tracking/topology/where_true.h"

namespace flowskin::tracking {
namespace {

constexpr double kSameSide = 0.5;

// Vertices, then triangle centres of a surface, with their normals.
class Samples {
 public:
  explicit Samples(const SurfaceGeometry& surface)
      : surface_(surface), normals_(vertex_normals(surface.positions, surface.triangles)) {}

  std::size_t count() const { return normals_.size() + surface_.triangles.size(); }
  Vec3 place(int i) const {
    return is_vertex(i) ? surface_.positions[i] : triangle_center(surface_.positions, triangle(i));
  }
  Vec3 normal(int i) const {
    return is_vertex(i) ? normals_[i] : doubled_area_vector(surface_.positions, triangle(i)).normalized();
  }

 private:
  bool is_vertex(int i) const { return i < std::ssize(normals_); }
  const Triangle& triangle(int i) const { return surface_.triangles[i - std::ssize(normals_)]; }

  const SurfaceGeometry& surface_;
  std::vector<Vec3> normals_;
};

SurfaceGeometry part_in(const CellSet& cells, const SparseGrid& grid, const std::vector<Vec3>& positions,
                        const std::vector<Triangle>& triangles) {
  SurfaceGeometry part;
  std::vector<int> number(positions.size(), -1);
  for (int t : where_true(triangles.size(), [&](int i) {
         const Vec3 x = grid.coordinates(positions[triangles[i][0]]);
         return meets(cells, x, x);
       })) {
    Triangle triangle = triangles[t];
    for (int& vertex : triangle) {
      if (number[vertex] < 0) {
        number[vertex] = static_cast<int>(part.positions.size());
        part.positions.push_back(positions[vertex]);
      }
      vertex = number[vertex];
    }
    part.triangles.push_back(triangle);
  }
  return part;
}

// The places of a surface in some cells that are farther than `reach` from another one.
void add_strays(const SparseGrid& grid, double reach, const SurfaceGeometry& surface, const SurfaceGeometry& other,
                const CellSet& where, std::vector<CellSet::Cell>& cells) {
  const Samples samples(surface);
  const ClosestPointTree tree(other.positions, other.triangles);
  const std::vector<int> far = where_true(samples.count(), [&](int i) {
    const Vec3 x = samples.place(i), place = grid.coordinates(x);
    return meets(where, place, place) && !tree.is_near(x, reach, samples.normal(i), kSameSide);
  });
  for (int i : far) {
    const Vec3 place = grid.coordinates(samples.place(i));
    add_cells(place, place, cells);
  }
}

}  // namespace

Strays::Strays(const SparseGrid& grid, double farthest, const SurfaceGeometry& mesh, const SurfaceGeometry& fresh) {
  measure(grid, farthest, mesh, fresh);
  measure(grid, farthest, fresh, mesh);
}

void Strays::measure(const SparseGrid& grid, double farthest, const SurfaceGeometry& surface,
                     const SurfaceGeometry& other) {
  const Samples samples(surface);
  const ClosestPointTree tree(other.positions, other.triangles);
  const std::size_t first = places_.size();
  places_.resize(first + samples.count());
#pragma omp parallel for schedule(dynamic, 256)
  for (int i = 0; i < static_cast<int>(samples.count()); ++i) {
    const Vec3 x = samples.place(i);
    const MeshPoint point = tree.closest(x, farthest, samples.normal(i), kSameSide);
    places_[first + i] = {grid.coordinates(x),
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

std::vector<CellSet::Cell> far_cells(const SparseGrid& grid, double reach, const std::vector<Vec3>& positions,
                                     const std::vector<Triangle>& triangles, const ClosestPointTree& other) {
  std::vector<char> used(positions.size());
  for (const Triangle& triangle : triangles) {
    for (int vertex : triangle) used[vertex] = 1;
  }
  const auto center = [&](int t) { return triangle_center(positions, triangles[t]); };
  std::vector<CellSet::Cell> cells;
  const auto add = [&](const Vec3& x) { add_cells(grid.coordinates(x), grid.coordinates(x), cells); };
  for (int v : where_true(positions.size(), [&](int i) { return used[i] && !other.is_near(positions[i], reach); }))
    add(positions[v]);
  for (int t : where_true(triangles.size(), [&](int i) { return !other.is_near(center(i), reach); })) add(center(t));
  return cells;
}

std::vector<CellSet::Cell> stray_cells(const SparseGrid& grid, double reach, const std::vector<Vec3>& positions,
                                       const std::vector<Triangle>& triangles, const CellSet& where,
                                       const ScalarFunction& field) {
  std::vector<CellSet::Cell> cells;
  if (where.empty()) return cells;
  // Whatever may be near enough or bear on the normals.
  const int layers = static_cast<int>(std::ceil(reach / grid.spacing()));
  const SurfaceGeometry fresh = march(grid, where.dilated(layers), field);
  const SurfaceGeometry near = part_in(where.dilated(1 + layers), grid, positions, triangles);
  add_strays(grid, reach, near, fresh, where, cells);
  add_strays(grid, reach, fresh, near, where, cells);
  return cells;
}

}  // namespace flowskin::tracking
