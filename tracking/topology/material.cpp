#include "tracking/topology/material.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "tracking/mesh/closest_point.h"
#include "tracking/mesh/point_tree.h"

namespace flowskin::tracking {
namespace {

constexpr double kSameSide = 0.3;         // cosine between a new vertex's normal and the old triangle's
constexpr double kForeign = 2.0;          // particles whose rest positions are this many radii from the nearest's
constexpr double kRegularization = 1e-6;  // of the moment matrix; keeps planar neighbourhoods solvable

// Nearest point of `targets` for each query, -1 where none is within reach.
std::vector<int> nearest(const std::vector<Vec3>& targets, const std::vector<Vec3>& queries, double reach) {
  std::vector<int> result(queries.size(), -1);
  if (targets.empty()) return result;
  const PointCloud cloud{targets};
  const PointTree tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(10));
#pragma omp parallel for schedule(static)
  for (int q = 0; q < static_cast<int>(queries.size()); ++q) {
    int index = -1;
    double squared = 0;
    if (tree.knnSearch(queries[q].data(), 1, &index, &squared) == 1 && squared <= reach * reach) result[q] = index;
  }
  return result;
}

// Neighbours of x, the nearest first is `nearest`; the support grows until it holds a particle.
// Only the first `count` particles of the field count.
int find_neighbors(const MetaballField& field, int count, const Vec3& x, double& radius, std::vector<int>& found) {
  radius = field.settings().radius;
  const auto find = [&] {
    field.neighbors(x, radius, found);
    std::erase_if(found, [count](int p) { return p >= count; });  // of a state that the field is leaving behind
  };
  for (find(); found.empty(); find()) radius *= 2;
  int nearest_particle = found.front();
  for (int p : found) {
    if ((field.positions()[p] - x).squaredNorm() < (field.positions()[nearest_particle] - x).squaredNorm()) {
      nearest_particle = p;
    }
  }
  return nearest_particle;
}

}  // namespace

Vec3 rest_position_at(const MetaballField& field, const Particles& particles, const Vec3& x) {
  std::vector<int> found;
  double radius = 0;
  const int closest = find_neighbors(field, static_cast<int>(particles.positions.size()), x, radius, found);
  using Vec4 = Eigen::Vector4d;
  Eigen::Matrix4d moments = Eigen::Matrix4d::Zero();
  Eigen::Matrix<double, 4, 3> sums = Eigen::Matrix<double, 4, 3>::Zero();
  for (int p : found) {
    const Vec3& rest = particles.rest_positions[p];
    if ((rest - particles.rest_positions[closest]).norm() > kForeign * radius) continue;
    const Vec3 offset = (particles.positions[p] - x) / radius;
    const double q = std::max(0.0, 1 - offset.squaredNorm());
    const double weight = q * q * q;
    const Vec4 basis(1, offset[0], offset[1], offset[2]);
    moments += weight * basis * basis.transpose();
    sums += weight * basis * (rest - particles.positions[p]).transpose();
  }
  if (!(moments(0, 0) > 0)) return x + particles.rest_positions[closest] - particles.positions[closest];
  for (int axis = 1; axis < 4; ++axis) moments(axis, axis) += kRegularization * moments(0, 0);
  return x + (moments.ldlt().solve(sums)).row(0).transpose();
}

std::vector<double> material_drift(const SurfaceMesh& mesh, const MetaballField& field, const Particles& particles) {
  std::vector<double> drift(mesh.positions.size());
#pragma omp parallel for schedule(dynamic, 256)
  for (int v = 0; v < static_cast<int>(drift.size()); ++v) {
    drift[v] = (rest_position_at(field, particles, mesh.positions[v]) - mesh.rest_positions[v]).norm();
  }
  return drift;
}

SurfaceMesh carry_material(const SurfaceMesh& old_mesh, const SurfaceGeometry& geometry,
                           const std::vector<Vec3>& normals, const MetaballField& field, const Particles& particles,
                           const MaterialSettings& settings) {
  const int count = static_cast<int>(geometry.positions.size());
  SurfaceMesh mesh;
  mesh.positions = geometry.positions;
  mesh.triangles = geometry.triangles;
  mesh.velocities.assign(count, Vec3::Zero());
  mesh.rest_positions.resize(count);
  mesh.ids.resize(count);
  mesh.next_id = old_mesh.next_id;

  const ClosestPointTree tree(old_mesh.positions, old_mesh.triangles);
  const auto interpolated = [&old_mesh](const MeshPoint& point, const std::vector<Vec3>& values) {
    Vec3 sum = Vec3::Zero();
    for (int corner = 0; corner < 3; ++corner) {
      sum += point.weights[corner] * values[old_mesh.triangles[point.triangle][corner]];
    }
    return sum;
  };
#pragma omp parallel for schedule(dynamic, 256)
  for (int v = 0; v < count; ++v) {
    const Vec3& x = mesh.positions[v];
    const MeshPoint point = tree.closest(x, settings.reach, normals[v], kSameSide);
    if (point.triangle >= 0) {
      mesh.rest_positions[v] = interpolated(point, old_mesh.rest_positions);
    } else if (!particles.rest_positions.empty()) {
      mesh.rest_positions[v] = rest_position_at(field, particles, x);
    } else {
      const MeshPoint far = tree.closest(x, settings.far_reach);
      mesh.rest_positions[v] =
          far.triangle < 0 ? x : x + interpolated(far, old_mesh.rest_positions) - interpolated(far, old_mesh.positions);
    }
  }

  const std::vector<int> old_of_new = nearest(old_mesh.positions, mesh.positions, settings.same_vertex);
  const std::vector<int> new_of_old = nearest(mesh.positions, old_mesh.positions, settings.same_vertex);
  for (int v = 0; v < count; ++v) {
    const int old = old_of_new[v];
    mesh.ids[v] = old >= 0 && new_of_old[old] == v ? old_mesh.ids[old] : mesh.next_id++;
  }
  return mesh;
}

}  // namespace flowskin::tracking
