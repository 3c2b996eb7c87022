#include "tools/pipeline/surface_statistics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/quantile.h"
#include "tracking/advection/particle_paths.h"
#include "tracking/extraction/extract_surface.h"
#include "tracking/ground_truth/surface_comparison.h"
#include "tracking/material/material.h"
#include "tracking/mesh/mesh_measures.h"
#include "tracking/mesh/self_intersections.h"

namespace flowskin::tools {

namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kGoodAngle = 10 * kDegree;
constexpr double kShortestGoodEdge = 0.5, kLongestGoodEdge = 1.5;  // in edge lengths

void describe_shape(const tracking::SurfaceMesh& mesh, const tracking::SurfaceGeometry& fresh, double edge_length,
                    FrameRow& row) {
  const tracking::SurfaceComparison comparison =
      tracking::compare_surfaces(mesh.positions, mesh.triangles, fresh, std::pow(edge_length, 3));
  row.components = comparison.mesh.components;
  row.expected_components = comparison.fresh.components;
  row.small_components = comparison.mesh.small_components;
  row.expected_small_components = comparison.fresh.small_components;
  row.euler = comparison.mesh.euler;
  row.expected_euler = comparison.fresh.euler;
  row.same_topology = comparison.same_topology() ? 1 : 0;
  row.volume = comparison.mesh.volume;
  row.expected_volume = comparison.fresh.volume;
  row.hausdorff = comparison.hausdorff;
  row.area = tracking::mesh_area(mesh.positions, mesh.triangles);
  row.self_intersections = tracking::self_intersections(mesh.positions, mesh.triangles).size();
}

void describe_triangles(const tracking::SurfaceMesh& mesh, double edge_length, FrameRow& row) {
  row.vertices = mesh.positions.size();
  row.triangles = mesh.triangles.size();
  const std::vector<double> angles = tracking::smallest_angles(mesh.positions, mesh.triangles);
  if (!angles.empty()) row.smallest_angle = *std::min_element(angles.begin(), angles.end()) / kDegree;
  row.good_angles = tracking::share_of_angles_above(angles, kGoodAngle);
  row.good_edges = tracking::share_of_edges_within(mesh.positions, mesh.triangles, kShortestGoodEdge * edge_length,
                                                   kLongestGoodEdge * edge_length);
  describe_stretch(mesh, row);
}

}  // namespace

void describe_surface(const tracking::SurfaceMesh& mesh, const tracking::Particles& particles,
                      const tracking::TrackerSettings& settings, FrameRow& row) {
  describe_triangles(mesh, settings.edge_length, row);
  if (particles.positions.empty()) return describe_shape(mesh, {}, settings.edge_length, row);
  const tracking::MetaballField field = tracking::field_of(particles, settings.field);
  describe_shape(mesh, tracking::extract_raw_surface(field, settings.edge_length), settings.edge_length, row);
  if (mesh.positions.empty() || particles.rest_positions.empty()) return;
  row.texture_drift = quantile(tracking::material_drift(mesh, field, particles), 0.5);
  row.material_scatter = quantile(tracking::material_scatter(field, particles), 0.5);
}

}  // namespace flowskin::tools
