// The point of a mesh that is closest to a given point.
#pragma once

#include <array>
#include <vector>

#include "common/triangle_tree.h"

namespace flowskin {

/// A point on a triangle: the sum of its corners times their weights (not negative, sum 1).
struct MeshPoint {
  int triangle = -1;  ///< -1: none was found.
  std::array<double, 3> weights{};
  double distance = 0;  ///< From the point asked for (m).
};

/// Distance from x to a triangle (m), and the weights of the corners that make its closest point.
double closest_on_triangle(const Vec3& x, const std::array<Vec3, 3>& corners, std::array<double, 3>& weights);

/// Finds closest points of a mesh, which must outlive it unchanged. Safe to ask from many threads.
class ClosestPointTree {
 public:
  ClosestPointTree(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles);

  /// Closest point nearer than `reach` (m). Where `normal` is not zero, only on triangles whose normal makes an angle
  /// with a cosine above `cosine` with it. Of equally near triangles, always the same one is found.
  MeshPoint closest(const Vec3& x, double reach, const Vec3& normal = Vec3::Zero(), double cosine = 0) const;

  /// Whether closest() finds something, which is known sooner than where it is.
  bool is_near(const Vec3& x, double reach, const Vec3& normal = Vec3::Zero(), double cosine = 0) const;

  /// Distance of a point to the mesh (m); any not larger than `near_enough` where that is so near, which is found
  /// sooner. Infinite where the mesh has no triangles.
  double distance(const Vec3& x, double near_enough = -1) const;

 private:
  struct Query {
    const Vec3& x;
    Vec3 normal;
    double cosine;
    double near_enough;  // the search ends where something as near is found
  };
  void search(int node, const Query& query, MeshPoint& best) const;

  const std::vector<Vec3>& positions_;
  const std::vector<Triangle>& triangles_;
  TriangleTree tree_;
};

}  // namespace flowskin
