#include "tracking/repair/grid_crossings.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace flowskin::tracking {
namespace {

constexpr int kTrianglesAtOnce = 4096;  // triangles

// A corner of a triangle seen along the lines.
struct Corner {
  int vertex;
  double u, v, height;
};

// On which side of the edge from a to b the shifted line lies: twice the area of the triangle that they make, with
// the sign of the shifted one where it is zero. Exactly opposite for the edge from b to a.
double side_of(const Corner& a, const Corner& b, int u, int v, bool& positive) {
  if (a.vertex > b.vertex) {
    const double side = -side_of(b, a, u, v, positive);
    positive = !positive;
    return side;
  }
  const double side = (b.u - a.u) * (v - a.v) - (b.v - a.v) * (u - a.u);
  // The line is shifted by (epsilon, epsilon^2).
  positive = side != 0 ? side > 0 : b.v != a.v ? b.v < a.v : b.u > a.u;
  return side;
}

void add_crossing(const std::array<Corner, 3>& corners, int u, int v, int triangle,
                  std::vector<GridCrossing>& crossings) {
  std::array<double, 3> weights{};
  std::array<bool, 3> positive{};
  for (int i = 0; i < 3; ++i) weights[i] = side_of(corners[(i + 1) % 3], corners[(i + 2) % 3], u, v, positive[i]);
  if (positive[0] != positive[1] || positive[1] != positive[2]) return;
  const double sum = weights[0] + weights[1] + weights[2];
  double place =
      sum != 0
          ? (weights[0] * corners[0].height + weights[1] * corners[1].height + weights[2] * corners[2].height) / sum
          : corners[0].height;
  // Rounding must not carry it out of the triangle.
  const auto [low, high] = std::minmax({corners[0].height, corners[1].height, corners[2].height});
  place = std::clamp(place, low, high);
  crossings.push_back({{u, v}, place, triangle, positive[0] ? -1 : 1});
}

// Of the triangles from `begin` to `end`.
void add_crossings(const SparseGrid& grid, int axis, const std::vector<Vec3>& positions,
                   const std::vector<Triangle>& triangles, int begin, int end, std::vector<GridCrossing>& crossings) {
  const int axis_u = (axis + 1) % 3, axis_v = (axis + 2) % 3;
  for (int t = begin; t < end; ++t) {
    std::array<Corner, 3> corners{};
    for (int i = 0; i < 3; ++i) {
      const Vec3 x = grid.coordinates(positions[triangles[t][i]]);
      corners[i] = {triangles[t][i], x[axis_u], x[axis_v], x[axis]};
    }
    const auto [low_u, high_u] = std::minmax({corners[0].u, corners[1].u, corners[2].u});
    const auto [low_v, high_v] = std::minmax({corners[0].v, corners[1].v, corners[2].v});
    for (int u = static_cast<int>(std::ceil(low_u)); u <= static_cast<int>(std::floor(high_u)); ++u) {
      for (int v = static_cast<int>(std::ceil(low_v)); v <= static_cast<int>(std::floor(high_v)); ++v) {
        add_crossing(corners, u, v, t, crossings);
      }
    }
  }
}

}  // namespace

std::vector<GridCrossing> grid_crossings(const SparseGrid& grid, int axis, const std::vector<Vec3>& positions,
                                         const std::vector<Triangle>& triangles) {
  const int count = static_cast<int>(triangles.size()), chunks = count / kTrianglesAtOnce + 1;
  std::vector<std::vector<GridCrossing>> of_chunk(chunks);
#pragma omp parallel for schedule(dynamic, 1)
  for (int chunk = 0; chunk < chunks; ++chunk) {
    add_crossings(grid, axis, positions, triangles, chunk * kTrianglesAtOnce,
                  std::min(count, (chunk + 1) * kTrianglesAtOnce), of_chunk[chunk]);
  }
  std::vector<GridCrossing> crossings;
  for (const auto& part : of_chunk) crossings.insert(crossings.end(), part.begin(), part.end());
  std::sort(crossings.begin(), crossings.end(), [](const GridCrossing& a, const GridCrossing& b) {
    return std::tie(a.line, a.place, a.triangle) < std::tie(b.line, b.place, b.triangle);
  });
  return crossings;
}

GridCrossings grid_crossings(const SparseGrid& grid, const std::vector<Vec3>& positions,
                             const std::vector<Triangle>& triangles) {
  return {grid_crossings(grid, 0, positions, triangles), grid_crossings(grid, 1, positions, triangles),
          grid_crossings(grid, 2, positions, triangles)};
}

}  // namespace flowskin::tracking
