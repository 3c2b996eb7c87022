#include "tracking/ground_truth/surface_comparison.h"

#include <algorithm>
#include <cmath>

#include "tracking/mesh/hausdorff.h"
#include "tracking/mesh/mesh_measures.h"

namespace flowskin::tracking {
namespace {

// Vertices - edges + triangles of each component.
std::vector<int> euler_of_components(int vertex_count, const std::vector<Triangle>& triangles,
                                     const MeshComponents& components) {
  std::vector<int> euler(components.count, 0);
  for (int component : components.of_vertex) {
    if (component >= 0) ++euler[component];
  }
  for (const auto& edge : build_topology(vertex_count, triangles).edges) --euler[components.of_vertex[edge[0]]];
  for (const Triangle& triangle : triangles) ++euler[components.of_vertex[triangle[0]]];
  return euler;
}

// The triangles of all but the small components.
std::vector<Triangle> large_parts(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                                  double small_volume) {
  const MeshComponents components = mesh_components(positions, triangles);
  std::vector<Triangle> large;
  for (const Triangle& triangle : triangles) {
    if (std::abs(components.volumes[components.of_vertex[triangle[0]]]) >= small_volume) large.push_back(triangle);
  }
  return large;
}

}  // namespace

SurfaceShape surface_shape(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                           double small_volume) {
  const MeshComponents components = mesh_components(positions, triangles);
  const std::vector<int> euler = euler_of_components(static_cast<int>(positions.size()), triangles, components);
  SurfaceShape shape;
  shape.components = components.count;
  shape.volume = mesh_volume(positions, triangles);
  for (int component = 0; component < components.count; ++component) {
    shape.euler += euler[component];
    const double size = std::abs(components.volumes[component]);
    shape.borderline += size > 0.5 * small_volume && size < 2 * small_volume;
    if (std::abs(components.volumes[component]) >= small_volume) continue;
    ++shape.small_components;
    shape.small_euler += euler[component];
  }
  return shape;
}

double SurfaceComparison::volume_error() const {
  return mesh.volume == fresh.volume ? 0 : mesh.volume / fresh.volume - 1;
}

SurfaceComparison compare_surfaces(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                                   const SurfaceGeometry& fresh, double small_volume) {
  SurfaceComparison comparison;
  comparison.mesh = surface_shape(positions, triangles, small_volume);
  comparison.fresh = surface_shape(fresh.positions, fresh.triangles, small_volume);
  comparison.hausdorff = std::max(
      one_sided_distance(positions, large_parts(positions, triangles, small_volume), fresh.positions, fresh.triangles),
      one_sided_distance(fresh.positions, large_parts(fresh.positions, fresh.triangles, small_volume), positions,
                         triangles));
  return comparison;
}

}  // namespace flowskin::tracking
