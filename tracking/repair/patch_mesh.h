// A piece of surface into which the border of another mesh is cut. See docs/topology.md.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "tracking/mesh/surface_mesh.h"

namespace flowskin::tracking {

/// An oriented surface, open or closed. Vertices of the other mesh are inserted into it, then edges between them; what
/// was inserted stays as it is. Every change keeps the surface two-manifold and its topology as it was.
class PatchMesh {
 public:
  PatchMesh(std::vector<Vec3> positions, std::vector<Triangle> triangles);

  /// Makes a vertex at x: where the surface is closest to x among the triangles that look along `normal`, a vertex that
  /// is not yet fixed and lies next to it moves there, or an edge or a triangle is split.
  /// @return the vertex, now fixed; -1 where the surface is farther than `reach` (m), or open there.
  int insert(const Vec3& x, const Vec3& normal, double reach);

  /// Makes an edge from a to b by flips (Sloan 1993), seen along `normal`; it is fixed then.
  /// @return false where fixed edges or the shape of the surface are in the way.
  bool connect(int a, int b, const Vec3& normal);

  /// The triangle that has the side from a to b, in this direction; -1 where there is none.
  int triangle_at(int a, int b) const;
  bool is_fixed(int a, int b) const;

  const std::vector<Vec3>& positions() const { return positions_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }

 private:
  struct Place;
  Place locate(const Vec3& x, const Vec3& normal, double reach) const;
  bool on_border(int vertex) const;
  bool move_to(int vertex, const Vec3& x);
  int split_triangle(int triangle, const Vec3& x);
  int split_edge(int a, int b, const Vec3& x);
  bool has_edge(int a, int b) const { return triangle_at(a, b) >= 0 || triangle_at(b, a) >= 0; }
  /// The vertex opposite of the side from a to b.
  int opposite(int a, int b) const;
  void flip(int a, int b, int left, int right);
  void replace(int triangle, const Triangle& corners);
  int add(const Triangle& corners);
  bool crossed_edges(int a, int b, const Vec3& normal, std::vector<std::array<int, 2>>& crossed) const;

  std::vector<Vec3> positions_;
  std::vector<Triangle> triangles_;
  std::vector<std::vector<int>> stars_;
  std::vector<char> is_fixed_vertex_;
  std::vector<std::array<int, 2>> fixed_edges_;  // (low, high)
};

}  // namespace flowskin::tracking
