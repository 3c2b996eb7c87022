#include "tracking/mesh/hausdorff.h"

#include <algorithm>

#include "common/closest_point.h"
#include "tracking/mesh/mesh_measures.h"

namespace flowskin::tracking {
namespace {

// Largest distance of a sample to the mesh of the tree, or `known` where that is larger. A search ends as soon as it
// finds a triangle no farther than the largest distance so far: that sample cannot change it [Taha and Hanbury, An
// Efficient Algorithm for Calculating the Exact Hausdorff Distance, 2015].
template <class Sample>
double farthest_sample(const ClosestPointTree& tree, std::size_t count, const Sample& sample, double known) {
  double farthest = known;
#pragma omp parallel for reduction(max : farthest) schedule(dynamic, 256)
  for (int i = 0; i < static_cast<int>(count); ++i) {
    farthest = std::max(farthest, tree.distance(sample(i), std::max(farthest, known)));
  }
  return farthest;
}

double one_sided(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                 const ClosestPointTree& tree, double farthest) {
  const auto center = [&](int t) { return triangle_center(positions, triangles[t]); };
  // Vertices are those of triangles: one that no triangle uses is not on the surface.
  std::vector<char> used(positions.size(), 0);
  for (const Triangle& triangle : triangles) {
    for (int vertex : triangle) used[vertex] = 1;
  }
  std::vector<Vec3> vertices;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    if (used[v]) vertices.push_back(positions[v]);
  }
  farthest = farthest_sample(
      tree, vertices.size(), [&](int v) { return vertices[v]; }, farthest);
  return farthest_sample(tree, triangles.size(), center, farthest);
}

}  // namespace

double hausdorff_distance(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                          const std::vector<Vec3>& other_positions, const std::vector<Triangle>& other_triangles) {
  const ClosestPointTree tree(positions, triangles), other_tree(other_positions, other_triangles);
  const double there = one_sided(positions, triangles, other_tree, 0);
  return one_sided(other_positions, other_triangles, tree, there);
}

double one_sided_distance(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                          const std::vector<Vec3>& other_positions, const std::vector<Triangle>& other_triangles) {
  return one_sided(positions, triangles, ClosestPointTree(other_positions, other_triangles), 0);
}

}  // namespace flowskin::tracking
