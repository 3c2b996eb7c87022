// The inside of a mesh that may have open parts as well, for many points.
#pragma once

#include <cstdint>
#include <vector>

#include "sph/geometry/triangle_mesh.h"

namespace flowskin::sph {

/// What of a mesh encloses space. Triangles at open edges are taken away until there are no open edges; what is left is
/// closed. Vertices are told apart by their position, and nothing is asked of the triangles' orientation: parts that
/// are oriented count by their winding number, so overlapping shells are one, the others by the parity of crossings.
class ClosedParts {
 public:
  explicit ClosedParts(const TriangleMesh& mesh);

  /// Whether nothing of the mesh is closed.
  bool empty() const { return triangles_.empty(); }
  /// Whether a point lies inside, by the crossings of the row along x that ends there.
  bool contains(const Vec3& p) const;

 private:
  struct Corners {
    Vec3 a, b, c;
    bool is_oriented;  // belongs to a part whose directed edges come in opposite pairs
  };
  std::size_t column_of(double value, Eigen::Index axis) const;
  void sort_into_columns();

  std::vector<Corners> triangles_;
  Box box_;
  // Triangles above each cell of the (y, z) plane, columns_ by columns_ of them over the box.
  std::size_t columns_ = 1;
  std::vector<std::vector<std::uint32_t>> cells_;
};

}  // namespace flowskin::sph
