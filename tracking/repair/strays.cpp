#include "tracking/repair/strays.h"

#include <array>
#include <cmath>
#include <limits>

#include "common/parallel.h"
#include "tracking/mesh/mesh_measures.h"

namespace flowskin::tracking {
namespace {

constexpr double kSheetSide = 0.5;
constexpr double kNearEnough = 0.1;  // cells, to first order

void add_cell_of(const SparseGrid& grid, const Vec3& x, std::vector<CellSet::Cell>& cells) {
  add_cells(grid.coordinates(x), grid.coordinates(x), cells);
}

// Whether the corners of a cell in a set hang together along its edges.
bool hang_together(int corners) {
  int reached = corners & -corners;
  for (int before = 0; before != reached;) {
    before = reached;
    for (int c = 0; c < 8; ++c) {
      if (reached >> c & 1) reached |= corners & (1 << (c ^ 1) | 1 << (c ^ 2) | 1 << (c ^ 4));
    }
  }
  return reached == corners;
}

// For each sign pattern whether it parts a cell in two: else interpolation and marching cubes may not agree.
const std::array<bool, 256>& parted_in_two() {
  static const std::array<bool, 256> table = [] {
    std::array<bool, 256> parted{};
    for (int pattern = 1; pattern < 255; ++pattern)
      parted[pattern] = hang_together(pattern) && hang_together(255 ^ pattern);
    return parted;
  }();
  return table;
}

// Distance, to first order, of a place from where the values interpolated in its cell are zero; infinite where they do
// not part the nodes of the cell in two. Both in cells.
double distance_in_cell(const SparseGrid& grid, const Vec3& coordinates) {
  const Vec3 floor = coordinates.array().floor(), place = coordinates - floor;
  const std::array<double, 8> values = grid.corner_values(cell_at(coordinates));
  double value = 0;
  Vec3 slope = Vec3::Zero();
  int pattern = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const std::array<int, 3> bit = {corner & 1, corner >> 1 & 1, corner >> 2};
    pattern |= values[corner] > 0 ? 1 << corner : 0;
    Vec3 weight;
    for (int axis = 0; axis < 3; ++axis) weight[axis] = bit[axis] ? place[axis] : 1 - place[axis];
    value += values[corner] * weight.prod();
    for (int axis = 0; axis < 3; ++axis)
      slope[axis] += (bit[axis] ? values[corner] : -values[corner]) * weight[(axis + 1) % 3] * weight[(axis + 2) % 3];
  }
  if (!parted_in_two()[pattern]) return std::numeric_limits<double>::infinity();
  return std::abs(value) / slope.norm();
}

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
    return meets(where, place, place) && !tree.is_near(x, reach, samples.normal(i), kSheetSide);
  });
  for (int i : far) add_cell_of(grid, samples.place(i), cells);
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
    const MeshPoint point = tree.closest(x, farthest, samples.normal(i), kSheetSide);
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

std::vector<CellSet::Cell> far_centers(const SparseGrid& grid, double reach, const SurfaceGeometry& surface,
                                       const ClosestPointTree& other) {
  const auto center = [&](int t) { return triangle_center(surface.positions, surface.triangles[t]); };
  std::vector<CellSet::Cell> cells;
  for (int t : where_true(surface.triangles.size(), [&](int i) { return !other.is_near(center(i), reach); }))
    add_cell_of(grid, center(t), cells);
  return cells;
}

std::vector<CellSet::Cell> far_from_grid_surface(const SparseGrid& grid, double reach,
                                                 const std::vector<Vec3>& positions,
                                                 const std::vector<Triangle>& triangles,
                                                 const ClosestPointTree& grid_surface) {
  std::vector<char> used(positions.size());
  for (const Triangle& triangle : triangles) {
    for (int vertex : triangle) used[vertex] = 1;
  }
  const auto center = [&](int t) { return triangle_center(positions, triangles[t]); };
  // Most centres are told to be near by the values around them, which costs a fifth; but a vertex at the tip of a rim
  // can be far although it seems to be near to first order.
  const auto is_far = [&](const Vec3& x) { return !grid_surface.is_near(x, reach); };
  const auto seems_near = [&](const Vec3& x) { return distance_in_cell(grid, grid.coordinates(x)) < kNearEnough; };
  std::vector<CellSet::Cell> cells;
  for (int v : where_true(positions.size(), [&](int i) { return used[i] && is_far(positions[i]); }))
    add_cell_of(grid, positions[v], cells);
  for (int t : where_true(triangles.size(), [&](int i) { return !seems_near(center(i)) && is_far(center(i)); }))
    add_cell_of(grid, center(t), cells);
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
