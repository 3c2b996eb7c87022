#include "surfaces/dense_distance.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "common/closest_point.h"
#include "tracking/mesh/mesh_measures.h"

namespace flowskin::surfaces {
namespace {

using tracking::SurfaceGeometry;
using tracking::Triangle;
using tracking::Vec3;

SurfaceGeometry large_parts(const SurfaceGeometry& surface, double small_volume) {
  const tracking::MeshComponents parts = tracking::mesh_components(surface.positions, surface.triangles);
  SurfaceGeometry large{surface.positions, {}};
  for (const Triangle& triangle : surface.triangles) {
    if (std::abs(parts.volumes[parts.of_vertex[triangle[0]]]) >= small_volume) large.triangles.push_back(triangle);
  }
  return large;
}

double farthest(const std::vector<Vec3>& points, const ClosestPointTree& tree) {
  double most = 0;
#pragma omp parallel for reduction(max : most) schedule(dynamic, 256)
  for (int i = 0; i < static_cast<int>(points.size()); ++i) most = std::max(most, tree.distance(points[i], most));
  return most;
}

}  // namespace

std::vector<Vec3> random_points(const SurfaceGeometry& surface, int count, std::uint64_t seed) {
  std::vector<Vec3> points(surface.triangles.size() * count);
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t t = 0; t < std::ssize(surface.triangles); ++t) {
    std::seed_seq seeds{seed, static_cast<std::uint64_t>(t)};
    std::minstd_rand random(seeds);
    std::uniform_real_distribution<double> share(0, 1);
    const auto& [a, b, c] = surface.triangles[t];
    for (int k = 0; k < count; ++k) {
      double u = share(random), v = share(random);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      points[t * count + k] = (1 - u - v) * surface.positions[a] + u * surface.positions[b] + v * surface.positions[c];
    }
  }
  return points;
}

double dense_hausdorff(const SurfaceGeometry& first, const SurfaceGeometry& second, double small_volume,
                       std::uint64_t seed) {
  const ClosestPointTree first_tree(first.positions, first.triangles), second_tree(second.positions, second.triangles);
  return std::max(farthest(random_points(large_parts(first, small_volume), kSamplesPerTriangle, seed), second_tree),
                  farthest(random_points(large_parts(second, small_volume), kSamplesPerTriangle, seed), first_tree));
}

}  // namespace flowskin::surfaces
