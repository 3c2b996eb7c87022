#include "tracking/ground_truth/mesh_errors.h"

#include <cmath>
#include <limits>
#include <unordered_map>

#include "common/closest_point.h"
#include "common/quantile.h"
#include "tracking/mesh/mesh_measures.h"

namespace flowskin::tracking {
namespace {

constexpr double kMarkerSide = 0.3;     // cosine between a marker's normal and that of the mesh beside it
constexpr double kSameMaterial = 1e-6;  // of the reach: a vertex whose rest position has moved less is what it was
constexpr double kAnywhere = std::numeric_limits<double>::infinity();
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

Vec3 interpolated(const std::vector<Vec3>& values, const std::vector<Triangle>& triangles, const MeshPoint& point) {
  Vec3 sum = Vec3::Zero();
  for (int corner = 0; corner < 3; ++corner) sum += point.weights[corner] * values[triangles[point.triangle][corner]];
  return sum;
}

/// Statistics of the values that are not NaN.
ErrorStatistics statistics_of(const std::vector<double>& all, double& found, int markers) {
  std::vector<double> values;
  double squares = 0;
  for (const double value : all) {
    if (std::isnan(value)) continue;
    values.push_back(value);
    squares += value * value;
  }
  found = markers > 0 ? static_cast<double>(values.size()) / markers : 0;
  if (values.empty()) return {};
  return {quantile(values, 0.5), quantile(values, 0.9), std::sqrt(squares / static_cast<double>(values.size()))};
}

/// NaN for markers that have left or that have no counterpart.
struct Distances {
  explicit Distances(std::size_t count)
      : texture(count, kNone), path(count, kNone), vertex_path(count, kNone), path_gap(count, kNone) {}
  std::vector<double> texture, path, vertex_path;
  std::vector<double> path_gap;  // between the marker's rest position and the closest one on the mesh
};

void measure_on_surface(const SurfaceMesh& mesh, const Markers& markers, double reach, Distances& distances) {
  const ClosestPointTree in_space(mesh.positions, mesh.triangles);
  const ClosestPointTree at_rest(mesh.rest_positions, mesh.triangles);
#pragma omp parallel for schedule(dynamic, 64)
  for (int i = 0; i < static_cast<int>(markers.ids.size()); ++i) {
    if (markers.left[i]) continue;
    const MeshPoint here = in_space.closest(markers.positions[i], reach, markers.normals[i], kMarkerSide);
    if (here.triangle >= 0)
      distances.texture[i] =
          (interpolated(mesh.rest_positions, mesh.triangles, here) - markers.rest_positions[i]).norm();
    const MeshPoint material = at_rest.closest(markers.rest_positions[i], kAnywhere);
    if (material.triangle < 0) continue;
    distances.path[i] = (interpolated(mesh.positions, mesh.triangles, material) - markers.positions[i]).norm();
    if (material.distance < reach) distances.path_gap[i] = material.distance;
  }
}

void measure_vertices(const SurfaceMesh& mesh, const Markers& markers, double reach, Distances& distances) {
  std::unordered_map<std::uint64_t, int> vertex_of;
  for (int v = 0; v < static_cast<int>(mesh.ids.size()); ++v) vertex_of.emplace(mesh.ids[v], v);
  for (std::size_t i = 0; i < markers.ids.size(); ++i) {
    const auto found = vertex_of.find(markers.ids[i]);
    if (markers.left[i] || found == vertex_of.end()) continue;
    const int v = found->second;
    if ((mesh.rest_positions[v] - markers.rest_positions[i]).norm() > kSameMaterial * reach) continue;
    distances.vertex_path[i] = (mesh.positions[v] - markers.positions[i]).norm();
  }
}

}  // namespace

MarkerErrors marker_errors(const SurfaceMesh& mesh, const Markers& markers, double reach) {
  Distances distances(markers.ids.size());
  if (!mesh.triangles.empty()) {
    measure_on_surface(mesh, markers, reach, distances);
    measure_vertices(mesh, markers, reach, distances);
  }
  MarkerErrors errors;
  const int count = markers.on_surface();
  errors.texture = statistics_of(distances.texture, errors.texture_found, count);
  errors.path = statistics_of(distances.path, errors.path_found, count);
  statistics_of(distances.path_gap, errors.path_found, count);
  errors.vertex_path = statistics_of(distances.vertex_path, errors.vertices_kept, count);
  return errors;
}

VelocityErrors velocity_errors(const SurfaceMesh& mesh, const Flow& flow) {
  const auto count = static_cast<int>(mesh.positions.size());
  std::vector<Vec3> truth(count);
#pragma omp parallel for schedule(dynamic, 64)
  for (int v = 0; v < count; ++v) truth[v] = flow(mesh.positions[v]);
  std::vector<double> areas(count, 0.0);
  for (const Triangle& triangle : mesh.triangles) {
    const double area = doubled_area_vector(mesh.positions, triangle).norm();
    for (const int vertex : triangle) areas[vertex] += area;
  }
  const std::vector<Vec3> normals = vertex_normals(mesh.positions, mesh.triangles);
  VelocityErrors sums;
  double all = 0;
  for (int v = 0; v < count; ++v) {
    const Vec3 error = mesh.velocities[v] - truth[v];
    const double normal_error = normals[v].dot(error), normal_flow = normals[v].dot(truth[v]);
    all += areas[v];
    sums.error += areas[v] * error.squaredNorm();
    sums.tangential_error += areas[v] * (error - normal_error * normals[v]).squaredNorm();
    sums.flow += areas[v] * truth[v].squaredNorm();
    sums.tangential_flow += areas[v] * (truth[v] - normal_flow * normals[v]).squaredNorm();
  }
  if (!(all > 0)) return {};
  return {sums.error / all, sums.tangential_error / all, sums.flow / all, sums.tangential_flow / all};
}

}  // namespace flowskin::tracking
