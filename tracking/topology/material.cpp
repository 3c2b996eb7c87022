#include "tracking/topology/material.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "tracking/mesh/closest_point.h"
#include "tracking/mesh/point_tree.h"

namespace flowskin::tracking {
namespace {

constexpr double kSameSide = 0.3;         // cosine between a new vertex's normal and the old triangle's
constexpr double kForeign = 2.0;          // particles whose rest positions are this many radii from the nearest's
constexpr double kRegularization = 1e-6;  // of the moment matrix; keeps planar neighbourhoods solvable

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

Vec3 material_place_at(const MetaballField& field, const std::vector<Vec3>& particle_places, const Vec3& x) {
  std::vector<int> found;
  double radius = 0;
  const int closest = find_neighbors(field, static_cast<int>(particle_places.size()), x, radius, found);
  using Vec4 = Eigen::Vector4d;
  Eigen::Matrix4d moments = Eigen::Matrix4d::Zero();
  Eigen::Matrix<double, 4, 3> sums = Eigen::Matrix<double, 4, 3>::Zero();
  for (int p : found) {
    const Vec3& rest = particle_places[p];
    if ((rest - particle_places[closest]).norm() > kForeign * radius) continue;
    const Vec3 offset = (field.positions()[p] - x) / radius;
    const double q = std::max(0.0, 1 - offset.squaredNorm());
    const double weight = q * q * q;
    const Vec4 basis(1, offset[0], offset[1], offset[2]);
    moments += weight * basis * basis.transpose();
    sums += weight * basis * (rest - field.positions()[p]).transpose();
  }
  if (!(moments(0, 0) > 0)) return x + particle_places[closest] - field.positions()[closest];
  for (int axis = 1; axis < 4; ++axis) moments(axis, axis) += kRegularization * moments(0, 0);
  return x + (moments.ldlt().solve(sums)).row(0).transpose();
}

Vec3 rest_position_at(const MetaballField& field, const Particles& particles, const Vec3& x) {
  return material_place_at(field, particles.rest_positions, x);
}

const std::vector<Vec3>& particle_layer(const Particles& particles, std::size_t k) {
  static const std::vector<Vec3> unknown;
  return k < particles.layers.size() ? particles.layers[k] : unknown;
}

std::vector<double> material_drift(const SurfaceMesh& mesh, const MetaballField& field, const Particles& particles) {
  std::vector<double> drift(mesh.positions.size());
#pragma omp parallel for schedule(dynamic, 256)
  for (int v = 0; v < static_cast<int>(drift.size()); ++v) {
    drift[v] = (rest_position_at(field, particles, mesh.positions[v]) - mesh.rest_positions[v]).norm();
  }
  return drift;
}

int limit_slip(double limit, const MetaballField& field, const Particles& particles, SurfaceMesh& mesh) {
  std::vector<char> held(mesh.positions.size());
#pragma omp parallel for schedule(dynamic, 256)
  for (int v = 0; v < static_cast<int>(held.size()); ++v) {
    const Vec3 beneath = rest_position_at(field, particles, mesh.positions[v]);
    const Vec3 slip = mesh.rest_positions[v] - beneath;
    const double distance = slip.norm();
    if (!(distance > limit)) continue;
    held[v] = 1;
    mesh.rest_positions[v] = beneath + limit / distance * slip;
  }
  return static_cast<int>(std::count(held.begin(), held.end(), 1));
}

MaterialCarrier::MaterialCarrier(const std::vector<Vec3>& positions, const std::vector<Vec3>& rest_positions,
                                 const std::vector<Triangle>& triangles, const MetaballField& field,
                                 const Particles& particles, const MaterialSettings& settings)
    : positions_(positions),
      rest_positions_(rest_positions),
      triangles_(triangles),
      field_(field),
      particles_(particles),
      settings_(settings),
      tree_(positions, triangles) {}

Vec3 MaterialCarrier::interpolated(const MeshPoint& point, const std::vector<Vec3>& values) const {
  Vec3 sum = Vec3::Zero();
  for (int corner = 0; corner < 3; ++corner) {
    sum += point.weights[corner] * values[triangles_[point.triangle][corner]];
  }
  return sum;
}

Vec3 MaterialCarrier::rest_position(const Vec3& x, const Vec3& normal) const {
  return place(x, normal, rest_positions_, particles_.rest_positions);
}

Vec3 MaterialCarrier::place(const Vec3& x, const Vec3& normal, const std::vector<Vec3>& on_mesh,
                            const std::vector<Vec3>& on_particles) const {
  const MeshPoint point = tree_.closest(x, settings_.reach, normal, kSameSide);
  if (point.triangle >= 0) return interpolated(point, on_mesh);
  if (!on_particles.empty()) return material_place_at(field_, on_particles, x);
  const MeshPoint far = tree_.closest(x, settings_.far_reach);
  return far.triangle < 0 ? x : x + interpolated(far, on_mesh) - interpolated(far, positions_);
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

  const MaterialCarrier material(old_mesh.positions, old_mesh.rest_positions, old_mesh.triangles, field, particles,
                                 settings);
#pragma omp parallel for schedule(dynamic, 256)
  for (int v = 0; v < count; ++v) mesh.rest_positions[v] = material.rest_position(mesh.positions[v], normals[v]);
  for (std::size_t k = 0; k < old_mesh.layers.size(); ++k) {
    const std::vector<Vec3>& beneath = particle_layer(particles, k);
    std::vector<Vec3>& layer = mesh.layers.emplace_back(count);
#pragma omp parallel for schedule(dynamic, 256)
    for (int v = 0; v < count; ++v)
      layer[v] = material.place(mesh.positions[v], normals[v], old_mesh.layers[k], beneath);
  }

  const std::vector<int> old_of_new = nearest_points(old_mesh.positions, mesh.positions, settings.same_vertex);
  const std::vector<int> new_of_old = nearest_points(mesh.positions, old_mesh.positions, settings.same_vertex);
  for (int v = 0; v < count; ++v) {
    const int old = old_of_new[v];
    mesh.ids[v] = old >= 0 && new_of_old[old] == v ? old_mesh.ids[old] : mesh.next_id++;
  }
  return mesh;
}

}  // namespace flowskin::tracking
