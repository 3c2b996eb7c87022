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
  for (const auto& edge : build_adjacency(vertex_count, triangles).edges) --euler[components.of_vertex[edge[0]]];
  for (const Triangle& triangle : triangles) ++euler[components.of_vertex[triangle[0]]];
  return euler;
}

// The triangles of all but the small components.
std::vector<Triangle> large_parts(const std::vector<Triangle>& triangles, const MeshComponents& components,
                                  double small_volume) {
  std::vector<Triangle> large;
  for (const Triangle& triangle : triangles) {
    if (std::abs(components.volumes[components.of_vertex[triangle[0]]]) >= small_volume) large.push_back(triangle);
  }
  return large;
}

SurfaceShape shape_of(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                      const MeshComponents& components, double small_volume) {
  const std::vector<int> euler = euler_of_components(static_cast<int>(positions.size()), triangles, components);
  SurfaceShape shape;
  shape.components = components.count;
  shape.volume = mesh_volume(positions, triangles);
  for (int component = 0; component < components.count; ++component) {
    shape.euler += euler[component];
    const double size = std::abs(components.volumes[component]);
    shape.borderline += size > 0.5 * small_volume && size < 2 * small_volume;
    if (size >= small_volume) continue;
    ++shape.small_components;
    shape.small_euler += euler[component];
  }
  return shape;
}

}  // namespace

SurfaceShape surface_shape(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                           double small_volume) {
  return shape_of(positions, triangles, mesh_components(positions, triangles), small_volume);
}

double SurfaceComparison::volume_error() const {
  return mesh.volume == fresh.volume ? 0 : mesh.volume / fresh.volume - 1;
}

SurfaceComparison compare_surfaces(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                                   const SurfaceGeometry& fresh, double small_volume) {
  const MeshComponents parts = mesh_components(positions, triangles);
  const MeshComponents fresh_parts = mesh_components(fresh.positions, fresh.triangles);
  SurfaceComparison comparison;
  comparison.mesh = shape_of(positions, triangles, parts, small_volume);
  comparison.fresh = shape_of(fresh.positions, fresh.triangles, fresh_parts, small_volume);
  comparison.hausdorff = std::max(
      one_sided_distance(positions, large_parts(triangles, parts, small_volume), fresh.positions, fresh.triangles),
      one_sided_distance(fresh.positions, large_parts(fresh.triangles, fresh_parts, small_volume), positions,
                         triangles));
  return comparison;
}

}  // namespace flowskin::tracking
