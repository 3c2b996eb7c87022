// The point of a mesh that is closest to a given point.
#pragma once

#include <array>
#include <vector>

#include "tracking/mesh/surface_mesh.h"

namespace flowskin::tracking {

/// A point on a triangle: the sum of its corners times their weights (not negative, sum 1).
struct MeshPoint {
  int triangle = -1;  ///< -1: none was found.
  std::array<double, 3> weights{};
  double distance = 0;  ///< From the point asked for (m).
};

/// Tree of bounding boxes over the triangles of a mesh, which must outlive it unchanged. Safe to ask from many threads.
class ClosestPointTree {
 public:
  ClosestPointTree(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles);

  /// Closest point nearer than `reach` (m). Where `normal` is not zero, only on triangles whose normal makes an angle
  /// with a cosine above `cosine` with it. Of equally near triangles, always the same one is found.
  MeshPoint closest(const Vec3& x, double reach, const Vec3& normal = Vec3::Zero(), double cosine = 0) const;

 private:
  struct Node {
    Vec3 low, high;
    int begin, end;  // triangles of a leaf, in order_
    int right;       // the left child follows its parent; -1: a leaf
  };
  int build(int begin, int end, const std::vector<Vec3>& centers);
  void search(int node, const Vec3& x, const Vec3& normal, double cosine, MeshPoint& best) const;

  const std::vector<Vec3>& positions_;
  const std::vector<Triangle>& triangles_;
  std::vector<int> order_;
  std::vector<Node> nodes_;
};

}  // namespace flowskin::tracking
