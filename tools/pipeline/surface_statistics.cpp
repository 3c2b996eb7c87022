#include "tools/pipeline/surface_statistics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/quantile.h"
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

// The columns that a comparison with a fresh extraction is not needed for.
void describe_shape(const tracking::SurfaceMesh& mesh, double edge_length, FrameRow& row) {
  const tracking::SurfaceShape shape =
      tracking::surface_shape(mesh.positions, mesh.triangles, std::pow(edge_length, 3));
  row.components = shape.components;
  row.small_components = shape.small_components;
  row.euler = shape.euler;
  row.volume = shape.volume;
  row.area = tracking::mesh_area(mesh.positions, mesh.triangles);
}

void compare_with_fresh(const tracking::SurfaceMesh& mesh, const tracking::SurfaceGeometry& fresh, double edge_length,
                        FrameRow& row) {
  const tracking::SurfaceComparison comparison =
      tracking::compare_surfaces(mesh.positions, mesh.triangles, fresh, std::pow(edge_length, 3));
  row.expected_components = comparison.fresh.components;
  row.expected_small_components = comparison.fresh.small_components;
  row.expected_euler = comparison.fresh.euler;
  row.same_topology = comparison.same_topology() ? 1 : 0;
  row.expected_volume = comparison.fresh.volume;
  row.hausdorff = comparison.hausdorff;
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

void describe_surface(const tracking::SurfaceMesh& mesh, const tracking::ImplicitField* field,
                      const tracking::Particles& particles, const tracking::TrackerSettings& settings, bool is_checked,
                      FrameRow& row) {
  row.checked = is_checked ? 1 : 0;
  describe_triangles(mesh, settings.edge_length, row);
  describe_shape(mesh, settings.edge_length, row);
  if (!is_checked) return;
  if (!field) return compare_with_fresh(mesh, {}, settings.edge_length, row);
  compare_with_fresh(mesh, tracking::extract_raw_surface(*field, settings.edge_length), settings.edge_length, row);
  if (mesh.positions.empty() || particles.rest_positions.empty()) return;
  row.texture_drift = quantile(tracking::material_drift(mesh, *field->particles(), particles), 0.5);
  row.material_scatter = quantile(tracking::material_scatter(*field->particles(), particles), 0.5);
}

}  // namespace flowskin::tools
