// Edge splits, collapses and flips on a closed two-manifold mesh, each with its vetoes.
#pragma once

#include <limits>
#include <vector>

#include "tracking/mesh/surface_mesh.h"

namespace flowskin::tracking {

/// Angle at x between the directions to a and b (rad).
double angle_at(const Vec3& x, const Vec3& a, const Vec3& b);

/// Works on positions and triangles in place; what a collapse removes stays as a gap until compact().
class EditableMesh {
 public:
  /// Keeps references to both.
  EditableMesh(std::vector<Vec3>& positions, std::vector<Triangle>& triangles);

  /// Merges `removed` into `kept`, which stays where it is. Refused, with false, where the edge does not exist, where
  /// the link condition fails (the mesh would stop being two-manifold: Dey et al. 1999), where a triangle would turn by
  /// more than 60 degrees or become a sliver, or where an edge would grow beyond `longest_edge` (m), or where the
  /// enclosed volume would change by more than `largest_volume` (m^3).
  bool collapse(int kept, int removed, double longest_edge,
                double largest_volume = std::numeric_limits<double>::infinity());

  /// Puts a new vertex, the last one, in the middle of edge ab and returns its index; -1 where there is no such edge.
  int split(int a, int b);

  /// Turns edge ab to the other diagonal of its two triangles. Refused, with false, where that edge exists already,
  /// where an end would keep fewer than three edges, or where the two triangles do not lie nearly in a plane.
  bool flip(int a, int b);

  /// True where the angles opposite of edge ab add up to more than 180 degrees and the slack (rad): the edge is not
  /// Delaunay.
  bool wants_flip(int a, int b, double slack = 1e-6) const;

  bool alive(int vertex) const { return !stars_[vertex].empty(); }
  /// Neighbours of a vertex, ascending.
  std::vector<int> ring(int vertex) const;

  /// Drops the removed vertices and triangles, keeping the order of the others. Returns the new index of each vertex,
  /// -1 for a removed one. Nothing else may be called afterwards.
  std::vector<int> compact();

 private:
  /// The two triangles of edge ab and the vertices opposite of it; false where there are not exactly two.
  bool wings(int a, int b, std::array<int, 2>& triangles, std::array<int, 2>& opposite) const;
  Vec3 star_normal(int vertex) const;
  bool collapse_keeps_shape(int kept, int removed, double longest_edge, double largest_volume) const;
  /// True where the link condition holds: the mesh stays two-manifold.
  bool may_collapse(int kept, int removed) const;
  /// @pre may_collapse
  void merge(int kept, int removed);

  std::vector<Vec3>& positions_;
  std::vector<Triangle>& triangles_;
  std::vector<std::vector<int>> stars_;  // triangles of each vertex
};

}  // namespace flowskin::tracking
