#include "tracking/fairing/bad_triangles.h"

#include <algorithm>

#include "tracking/fairing/relaxation.h"
#include "tracking/mesh/mesh_measures.h"

namespace flowskin::tracking {
namespace {

constexpr double kFoldedCosine = -0.93;  // neighbouring triangles with an inner angle below 21 degrees
constexpr double kLeastShape = 1e-3;     // doubled area over the longest squared side

}  // namespace

bool is_degenerate(const Triangle& triangle, const std::vector<Vec3>& positions) {
  double longest = 0;
  for (int corner = 0; corner < 3; ++corner) {
    longest = std::max(longest, (positions[triangle[corner]] - positions[triangle[(corner + 1) % 3]]).squaredNorm());
  }
  return !(doubled_area_vector(positions, triangle).norm() > kLeastShape * longest);
}

std::vector<int> bad_triangles(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                               const MeshAdjacency& topology, const std::vector<Vec3>& normals) {
  std::vector<int> bad;
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
    if (is_degenerate(triangles[t], positions) || is_inverted(triangles[t], positions, normals)) bad.push_back(t);
  }
  for (const auto& [first, second] : topology.edge_triangles) {
    if (second < 0) continue;
    const Vec3 a = doubled_area_vector(positions, triangles[first]);
    const Vec3 b = doubled_area_vector(positions, triangles[second]);
    if (a.dot(b) < kFoldedCosine * a.norm() * b.norm()) bad.insert(bad.end(), {first, second});
  }
  std::sort(bad.begin(), bad.end());
  bad.erase(std::unique(bad.begin(), bad.end()), bad.end());
  return bad;
}

}  // namespace flowskin::tracking
