#include "tracking/material/material.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "common/closest_point.h"
#include "tracking/material/surface_material.h"
#include "tracking/mesh/mesh_measures.h"
#include "tracking/mesh/vertex_attributes.h"

namespace flowskin::tracking {
namespace {

constexpr double kSameSide = 0.3;         // cosine between a new vertex's normal and the old triangle's
constexpr double kForeign = 2.0;          // particles whose rest positions are this many radii from the nearest's
constexpr double kTorn = 0.15;            // radii by which the fit may miss the displacement of the nearest particle
constexpr double kRegularization = 1e-6;  // of the moment matrix; keeps planar neighbourhoods solvable

// Neighbours of x, the nearest first is `nearest`; the support grows until it holds a particle.
// Only the first `count` particles of the field count.
int find_neighbors(const ParticleField& field, int count, const Vec3& x, double& radius, std::vector<int>& found) {
  radius = field.radius();
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

// Whether two corners that are neighbours now were so far from each other that they are not of one body.
bool is_torn(const Triangle& triangle, const std::vector<Vec3>& positions, const std::vector<Vec3>& places) {
  const auto longest = [&](const std::vector<Vec3>& points) {
    double squared = 0;
    for (int corner = 0; corner < 3; ++corner)
      squared = std::max(squared, (points[triangle[(corner + 1) % 3]] - points[triangle[corner]]).squaredNorm());
    return std::sqrt(squared);
  };
  return longest(places) > kTornEdge * longest(positions);
}

// Displacements around x: moving least squares of first order.
class DisplacementFit {
 public:
  template <class Displacement>
  DisplacementFit(const ParticleField& field, const Displacement& displacement, const Vec3& x, double radius,
                  const std::vector<int>& particles)
      : x_(x), radius_(radius) {
    Eigen::Matrix4d moments = Eigen::Matrix4d::Zero();
    Coefficients sums = Coefficients::Zero();
    for (int p : particles) {
      const Eigen::Vector4d basis = basis_at(field.positions()[p]);
      const double q = std::max(0.0, 1 - basis.tail<3>().squaredNorm());
      const double weight = q * q * q;
      moments += weight * basis * basis.transpose();
      sums += weight * basis * displacement(p).transpose();
    }
    is_known_ = moments(0, 0) > 0;
    if (!is_known_) return;
    for (int axis = 1; axis < 4; ++axis) moments(axis, axis) += kRegularization * moments(0, 0);
    coefficients_ = moments.ldlt().solve(sums);
  }
  bool is_known() const { return is_known_; }
  Vec3 at(const Vec3& place) const { return coefficients_.transpose() * basis_at(place); }

 private:
  using Coefficients = Eigen::Matrix<double, 4, 3>;
  Eigen::Vector4d basis_at(const Vec3& place) const {
    const Vec3 offset = (place - x_) / radius_;
    return {1, offset[0], offset[1], offset[2]};
  }

  Vec3 x_;
  double radius_;
  bool is_known_ = false;
  Coefficients coefficients_ = Coefficients::Zero();
};

}  // namespace

Vec3 material_place_at(const ParticleField& field, const std::vector<Vec3>& particle_places, const Vec3& x) {
  std::vector<int> found;
  double radius = 0;
  const int closest = find_neighbors(field, static_cast<int>(particle_places.size()), x, radius, found);
  std::erase_if(found,
                [&](int p) { return (particle_places[p] - particle_places[closest]).norm() > kForeign * radius; });
  const auto displacement = [&](int p) { return Vec3(particle_places[p] - field.positions()[p]); };
  const DisplacementFit fit(field, displacement, x, radius, found);
  const Vec3 known = displacement(closest);
  if (!fit.is_known()) return x + known;
  if ((fit.at(field.positions()[closest]) - known).norm() <= kTorn * radius) return x + fit.at(x);
  // Two bodies have met here, or one has torn: the nearest particle's half, as the displacements tell.
  const int farthest = *std::max_element(found.begin(), found.end(), [&](int a, int b) {
    return (displacement(a) - known).squaredNorm() < (displacement(b) - known).squaredNorm();
  });
  const Vec3 other = displacement(farthest);
  std::erase_if(
      found, [&](int p) { return (displacement(p) - other).squaredNorm() < (displacement(p) - known).squaredNorm(); });
  const DisplacementFit half(field, displacement, x, radius, found);
  return x + (half.is_known() ? half.at(x) : known);
}

Vec3 rest_position_at(const ParticleField& field, const Particles& particles, const Vec3& x) {
  return material_place_at(field, particles.rest_positions, x);
}

const std::vector<Vec3>& particle_layer(const Particles& particles, std::size_t k) {
  static const std::vector<Vec3> unknown;
  return k < particles.layers.size() ? particles.layers[k] : unknown;
}

std::vector<double> material_drift(const SurfaceMesh& mesh, const ParticleField& field, const Particles& particles) {
  std::vector<double> drift(mesh.positions.size());
#pragma omp parallel for schedule(dynamic, 256)
  for (int v = 0; v < static_cast<int>(drift.size()); ++v) {
    drift[v] = (rest_position_at(field, particles, mesh.positions[v]) - mesh.rest_positions[v]).norm();
  }
  return drift;
}

std::vector<double> material_scatter(const ParticleField& field, const Particles& particles, std::size_t most) {
  const std::size_t count = particles.rest_positions.size(), step = std::max<std::size_t>(1, count / most);
  std::vector<double> scatter(count / step, std::numeric_limits<double>::quiet_NaN());
  const double radius = field.radius();
  const auto displacement = [&](int p) { return Vec3(particles.rest_positions[p] - particles.positions[p]); };
#pragma omp parallel for schedule(dynamic, 16)
  for (std::ptrdiff_t i = 0; i < std::ssize(scatter); ++i) {
    const auto particle = static_cast<int>(static_cast<std::size_t>(i) * step);
    const Vec3& x = particles.positions[particle];
    std::vector<int> others;
    field.neighbors(x, radius, others);
    std::erase_if(others, [&](int p) { return p == particle || p >= static_cast<int>(count); });
    const DisplacementFit fit(field, displacement, x, radius, others);
    if (fit.is_known()) scatter[i] = (fit.at(x) - displacement(particle)).norm();
  }
  std::erase_if(scatter, [](double distance) { return std::isnan(distance); });
  return scatter;
}

int limit_slip(double limit, const ParticleField& field, const Particles& particles, SurfaceMesh& mesh) {
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

MaterialCarrier::MaterialCarrier(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                                 const ImplicitField& field, const Particles& particles,
                                 const MaterialSettings& settings)
    : positions_(positions),
      triangles_(triangles),
      field_(field),
      particles_(particles),
      settings_(settings),
      tree_(positions, triangles),
      adjacency_(build_adjacency(static_cast<int>(positions.size()), triangles)),
      normals_(vertex_normals(positions, triangles)) {}

Vec3 MaterialCarrier::on_triangle(const MeshPoint& point, const std::vector<Vec3>& values) const {
  const Triangle& corners = triangles_[point.triangle];
  Vec3 sum = Vec3::Zero();
  for (int corner = 0; corner < 3; ++corner) sum += point.weights[corner] * values[corners[corner]];
  return sum;
}

Vec3 MaterialCarrier::on_surface(const MeshPoint& point, const std::vector<Vec3>& values) const {
  const Triangle& corners = triangles_[point.triangle];
  const int heaviest = corners[std::max_element(point.weights.begin(), point.weights.end()) - point.weights.begin()];
  if (is_torn(corners, positions_, values)) return values[heaviest];
  const MaterialChart chart({positions_, adjacency_, normals_}, heaviest, values);
  return chart.place_at(chart.on_surface(on_triangle(point, positions_)), values);
}

void MaterialCarrier::append_material(const SurfaceMesh& old, std::span<const Vec3> places,
                                      std::span<const Vec3> normals, SurfaceMesh& mesh) const {
  const std::size_t layers = old.layers.size(), first = mesh.rest_positions.size();
  bool particles_know = !particles_.rest_positions.empty();
  for (std::size_t k = 0; k < layers; ++k) particles_know = particles_know && !particle_layer(particles_, k).empty();
  mesh.layers.resize(layers);
  mesh.rest_positions.resize(first + places.size());
  for (auto& layer : mesh.layers) layer.resize(first + places.size());
#pragma omp parallel for schedule(dynamic, 16)
  for (std::ptrdiff_t i = 0; i < std::ssize(places); ++i) {
    const Source source = source_of(places[i], normals[i], particles_know);
    mesh.rest_positions[first + i] = place(places[i], source, old.rest_positions, particles_.rest_positions);
    for (std::size_t k = 0; k < layers; ++k)
      mesh.layers[k][first + i] = place(places[i], source, old.layers[k], particle_layer(particles_, k));
  }
}

MaterialCarrier::Source MaterialCarrier::source_of(const Vec3& x, const Vec3& normal, bool particles_know) const {
  Source source;
  source.same_side = tree_.closest(x, settings_.reach, normal, kSameSide);
  if (source.same_side.triangle < 0 && !particles_know) source.any_side = tree_.closest(x, settings_.far_reach);
  return source;
}

Vec3 MaterialCarrier::place(const Vec3& x, const Source& source, const std::vector<Vec3>& on_mesh,
                            const std::vector<Vec3>& on_particles) const {
  if (source.same_side.triangle >= 0) return on_surface(source.same_side, on_mesh);
  if (!on_particles.empty())
    return material_place_at(particles_of(field_, "the material of particles"), on_particles, x);
  const MeshPoint& far = source.any_side;
  return far.triangle < 0 ? x : x + on_triangle(far, on_mesh) - on_triangle(far, positions_);
}

std::vector<int> same_vertices(const SurfacePoints& old_vertices, const SurfacePoints& new_vertices, double reach) {
  return paired_points(old_vertices, new_vertices, reach, 0);
}

SurfaceMesh carry_material(const SurfaceMesh& old_mesh, const SurfaceGeometry& geometry,
                           const std::vector<Vec3>& normals, const ImplicitField& field, const Particles& particles,
                           const MaterialSettings& settings) {
  const int count = static_cast<int>(geometry.positions.size());
  SurfaceMesh mesh;
  mesh.positions = geometry.positions;
  mesh.triangles = geometry.triangles;
  mesh.next_id = old_mesh.next_id;
  MaterialCarrier(old_mesh.positions, old_mesh.triangles, field, particles, settings)
      .append_material(old_mesh, mesh.positions, normals, mesh);
  resize_attributes(mesh.positions.size(), mesh);

  const std::vector<Vec3> old_normals = vertex_normals(old_mesh.positions, old_mesh.triangles);
  const std::vector<int> same =
      same_vertices({old_mesh.positions, old_normals}, {mesh.positions, normals}, settings.same_vertex);
  for (int v = 0; v < count; ++v) mesh.ids[v] = same[v] >= 0 ? old_mesh.ids[same[v]] : mesh.next_id++;
  return mesh;
}

}  // namespace flowskin::tracking
