#include "tools/pipeline/method_measures.h"

#include <cmath>
#include <numbers>
#include <numeric>

#include "common/quantile.h"
#include "tools/pipeline/surface_statistics.h"
#include "tracking/field/metaballs/metaball_field.h"
#include "tracking/ground_truth/mesh_errors.h"
#include "tracking/material/material.h"
#include "tracking/mesh/mesh_measures.h"

namespace flowskin::tools {
namespace {

void add_markers(const tracking::Markers& markers, const tracking::MetaballField& field,
                 const tracking::Particles& particles, CompareRow& row) {
  std::vector<double> depths, drifts;
  for (std::size_t i = 0; i < markers.ids.size(); ++i) {
    if (markers.left[i]) continue;
    depths.push_back(markers.depths[i]);
    const Vec3 rest = tracking::rest_position_at(field, particles, markers.positions[i]);
    drifts.push_back((rest - markers.rest_positions[i]).norm());
  }
  row.markers = int(depths.size());
  row.markers_left = int(markers.ids.size() - depths.size());
  row.marker_depth = quantile(depths, 0.5);
  row.marker_drift = quantile(drifts, 0.5);
}

double relative(double error, double flow) { return flow > 0 ? std::sqrt(error / flow) : 0; }

void add_marker_errors(const tracking::MarkerErrors& errors, CompareRow& row) {
  row.texture_median = errors.texture.median;
  row.texture_p90 = errors.texture.p90;
  row.texture_rms = errors.texture.rms;
  row.texture_found = errors.texture_found;
  row.path_median = errors.path.median;
  row.path_p90 = errors.path.p90;
  row.path_rms = errors.path.rms;
  row.path_found = errors.path_found;
  row.vertex_path_median = errors.vertex_path.median;
  row.vertex_path_rms = errors.vertex_path.rms;
  row.vertices_kept = errors.vertices_kept;
}

void add_velocity_errors(const tracking::VelocityErrors& errors, CompareRow& row) {
  row.velocity_error = relative(errors.error, errors.flow);
  row.tangential_error = relative(errors.tangential_error, errors.tangential_flow);
  row.flow_speed = std::sqrt(errors.flow);
  row.tangential_speed = std::sqrt(errors.tangential_flow);
}

void add_mesh(const tracking::SurfaceMesh& mesh, CompareRow& row) {
  row.vertices = mesh.positions.size();
  row.triangles = mesh.triangles.size();
  constexpr double degrees = 180 / std::numbers::pi;
  const std::vector<double> angles = tracking::smallest_angles(mesh.positions, mesh.triangles);
  row.angle_min = degrees * quantile(angles, 0);
  row.angle_p05 = degrees * quantile(angles, 0.05);
  if (!angles.empty())
    row.angle_mean = degrees * std::accumulate(angles.begin(), angles.end(), 0.0) / double(angles.size());
  describe_stretch(mesh, row);
}

}  // namespace

MethodMeasures::MethodMeasures(const GroundTruth& truth, double reach)
    : truth_(truth), reach_(reach), field_(truth.field()), flow_(truth.flow()) {
  add_markers(truth.markers(), field_, truth.particles(), of_markers_);
}

void MethodMeasures::add_to(CompareRow& row, const tracking::Tracker& tracker) const {
  const tracking::SurfaceMesh& mesh = tracker.mesh();
  const tracking::Particles& particles = truth_.particles();
  row.time = particles.time;
  row.max_slip = tracker.settings().max_slip;
  row.components = tracker.report().components;
  row.max_distance = tracker.report().max_distance;
  row.markers = of_markers_.markers;
  row.markers_left = of_markers_.markers_left;
  row.marker_depth = of_markers_.marker_depth;
  row.marker_drift = of_markers_.marker_drift;
  add_mesh(mesh, row);
  add_marker_errors(tracking::marker_errors(mesh, truth_.markers(), reach_), row);
  add_velocity_errors(tracking::velocity_errors(mesh, flow_), row);
  if (!mesh.positions.empty() && !particles.positions.empty())
    row.texture_drift = quantile(tracking::material_drift(mesh, field_, particles), 0.5);
}

}  // namespace flowskin::tools
