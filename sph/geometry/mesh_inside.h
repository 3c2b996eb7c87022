// Which points of a lattice lie inside a closed triangle mesh.
#pragma once

#include <vector>

#include "common/triangle_tree.h"
#include "sph/geometry/triangle_mesh.h"

namespace flowskin::sph {

/// Whether each directed edge of the mesh is matched by one in the opposite direction (vertices told apart by
/// position).
bool is_closed(const TriangleMesh& mesh);

/// Points of the lattice low + (i + 1/2, j + 1/2, k + 1/2) spacing, low being the lower corner of the mesh's bounding
/// box, that lie inside the closed mesh: along each lattice row the crossings of the surface are counted with their
/// sign (winding number), so hollows stay empty and overlapping shells are filled once.
std::vector<Vec3> lattice_points_inside(const TriangleMesh& mesh, double spacing);

/// Whether a point lies inside a closed mesh, by the same rule.
bool is_inside(const TriangleMesh& mesh, const Vec3& p);

/// The same answer for many points: a tree finds the triangles that the row through a point can cross.
class InsideTest {
 public:
  /// @param mesh must outlive it unchanged
  explicit InsideTest(const TriangleMesh& mesh) : mesh_(mesh), tree_(mesh.positions, mesh.triangles) {}
  bool operator()(const Vec3& p) const;

 private:
  const TriangleMesh& mesh_;
  TriangleTree tree_;
};

}  // namespace flowskin::sph
