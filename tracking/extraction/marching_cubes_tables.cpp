#include "tracking/extraction/marching_cubes_tables.h"

#include <stdexcept>
#include <utility>

namespace flowskin::tracking {
namespace {

using Polygon = std::vector<int>;  // edges of the cell

// The unit steps along the axes, as bits of a corner.
int corner_of(int axis, int along, int u, int v) { return along << axis | u << (axis + 1) % 3 | v << (axis + 2) % 3; }

int edge_between(int a, int b) {
  const int axis = (a ^ b) == 1 ? 0 : (a ^ b) == 2 ? 1 : 2;
  return 4 * axis + (a >> (axis + 1) % 3 & 1) + 2 * (a >> (axis + 2) % 3 & 1);
}

std::array<std::array<int, 2>, 12> make_edge_corners() {
  std::array<std::array<int, 2>, 12> corners{};
  for (int edge = 0; edge < 12; ++edge) {
    const int axis = edge / 4;
    corners[edge] = {corner_of(axis, 0, edge & 1, edge >> 1 & 1), corner_of(axis, 1, edge & 1, edge >> 1 & 1)};
  }
  return corners;
}

// The corners of face (axis, side), counter-clockwise seen from outside the cell.
std::array<int, 4> face_corners(int axis, int side) {
  std::array<int, 4> corners = {corner_of(axis, side, 0, 0), corner_of(axis, side, 1, 0), corner_of(axis, side, 1, 1),
                                corner_of(axis, side, 0, 1)};
  if (side == 0) std::swap(corners[1], corners[3]);
  return corners;
}

// next[e] is the edge on which the segment that begins on edge e ends; -1 where none begins. Walking around a face
// counter-clockwise, a segment leads from where an inside run is entered to where it is left.
std::array<int, 12> make_segments(int pattern) {
  std::array<int, 12> next{};
  next.fill(-1);
  for (int face = 0; face < 6; ++face) {
    const std::array<int, 4> corners = face_corners(face / 2, face % 2);
    const auto inside = [&](int i) { return (pattern >> corners[i % 4] & 1) != 0; };
    for (int i = 0; i < 4; ++i) {
      if (inside(i) || !inside(i + 1)) continue;
      int last = i + 1;
      while (inside(last + 1)) ++last;
      next[edge_between(corners[i], corners[(i + 1) % 4])] = edge_between(corners[last % 4], corners[(last + 1) % 4]);
    }
  }
  return next;
}

bool share_face(const std::array<int, 2>& first, const std::array<int, 2>& second) {
  for (int axis = 0; axis < 3; ++axis) {
    const int bits =
        (first[0] >> axis & 1) + (first[1] >> axis & 1) + (second[0] >> axis & 1) + (second[1] >> axis & 1);
    if (bits == 0 || bits == 4) return true;
  }
  return false;
}

using Triangles = CellTables::Triangles;

// All of the one with all of the other.
std::vector<Triangles> combined(const std::vector<Triangles>& first, const std::vector<Triangles>& second) {
  std::vector<Triangles> all;
  for (const Triangles& begin : first) {
    for (const Triangles& end : second) {
      all.push_back(begin);
      all.back().insert(all.back().end(), end.begin(), end.end());
    }
  }
  return all;
}

// All ways to cut polygon[first..last] into triangles; the side first-last belongs to what is already cut.
std::vector<Triangles> triangulations(const Polygon& polygon, int first, int last, const CellTables& tables) {
  if (last - first < 2) return {{}};
  const auto allowed = [&](int i, int j) {
    return j - i == 1 || !share_face(tables.edge_corners[polygon[i]], tables.edge_corners[polygon[j]]);
  };
  std::vector<Triangles> all;
  for (int apex = first + 1; apex < last; ++apex) {
    if (!allowed(first, apex) || !allowed(apex, last)) continue;
    const std::vector<Triangles> here{{{polygon[first], polygon[apex], polygon[last]}}};
    for (Triangles& triangles : combined(combined(here, triangulations(polygon, first, apex, tables)),
                                         triangulations(polygon, apex, last, tables)))
      all.push_back(std::move(triangles));
  }
  return all;
}

CellTables make_tables() {
  CellTables tables;
  tables.edge_corners = make_edge_corners();
  for (int pattern = 0; pattern < 256; ++pattern) {
    std::array<int, 12> next = make_segments(pattern);
    std::vector<Triangles>& all = tables.triangulations[pattern];
    all.emplace_back();
    for (int start = 0; start < 12; ++start) {
      Polygon polygon;
      for (int edge = start; next[edge] >= 0;) {
        polygon.push_back(edge);
        const int following = next[edge];
        next[edge] = -1;
        edge = following;
      }
      all = combined(all, triangulations(polygon, 0, static_cast<int>(polygon.size()) - 1, tables));
    }
    if (all.empty()) throw std::logic_error("marching cubes: a polygon has no diagonals off the faces of its cell");
  }
  return tables;
}

}  // namespace

const CellTables& cell_tables() {
  static const CellTables tables = make_tables();
  return tables;
}

}  // namespace flowskin::tracking
