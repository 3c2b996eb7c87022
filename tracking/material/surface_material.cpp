#include "tracking/material/surface_material.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "tracking/mesh/mesh_measures.h"
#include "tracking/mesh/vertex_attributes.h"

namespace flowskin::tracking {
namespace {

constexpr std::size_t kFewest = 5;   // neighbours that tell the second derivatives
constexpr double kStiffness = 1e-6;  // of the moments; keeps neighbours on a curve solvable
// Weights fall so fast that the nearest neighbours are all but met: smoother fits blur what passes over many vertices.
constexpr double kBlunt = 0.02;    // of the squared radius, below which distances are all alike
constexpr double kUnmoved = 1e-9;  // of an edge: a shorter slide is none
constexpr double kNoArea = 1e-6;   // of the product of two derivatives, whose normal is noise below

using Basis = Eigen::Matrix<double, 5, 1>;
using Moments = Eigen::Matrix<double, 5, 5>;

Basis basis_at(double u, double v) { return {u, v, u * u, u * v, v * v}; }

// Two tangents and the normal that they span; no normal where they are nearly parallel.
Mat3 frame_of(const Vec3& u_tangent, const Vec3& v_tangent) {
  const Vec3 normal = u_tangent.cross(v_tangent);
  const double area = normal.norm();
  const bool spans = area > kNoArea * u_tangent.norm() * v_tangent.norm();
  Mat3 frame;
  frame << u_tangent, v_tangent, spans ? Vec3(normal / area) : Vec3(Vec3::Zero());
  return frame;
}

}  // namespace

MaterialChart::MaterialChart(const KnownSurface& surface, int vertex, const std::vector<Vec3>& places)
    : vertex_(vertex), positions_(surface.positions), normal_(surface.normals[vertex]) {
  u_axis_ = normal_.unitOrthogonal();
  v_axis_ = normal_.cross(u_axis_);
  gather(surface.adjacency, places);
  if (neighbors_.size() < kFewest || normal_.isZero())
    neighbors_.clear();
  else
    solve_shares();
}

// The ring and its rings, in the order of their numbers.
void MaterialChart::gather(const MeshAdjacency& adjacency, const std::vector<Vec3>& places) {
  thread_local std::vector<int> found;
  found.clear();
  for (const auto& near : adjacency.ring(vertex_)) {
    found.push_back(near.vertex);
    for (const auto& far : adjacency.ring(near.vertex)) found.push_back(far.vertex);
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  neighbors_.reserve(found.size());
  for (const int other : found) {
    const Vec3 offset = positions_[other] - positions_[vertex_];
    if (other == vertex_ || (places[other] - places[vertex_]).norm() > kTornEdge * offset.norm()) continue;
    neighbors_.push_back({other, offset, {}});
    radius_ = std::max(radius_, offset.norm());
  }
}

void MaterialChart::solve_shares() {
  Moments moments = Moments::Zero();
  const auto basis_of = [&](const Neighbor& neighbor) {
    return basis_at(u_axis_.dot(neighbor.offset) / radius_, v_axis_.dot(neighbor.offset) / radius_);
  };
  const auto weight_of = [&](const Neighbor& neighbor) {
    return std::pow(neighbor.offset.squaredNorm() / (radius_ * radius_) + kBlunt, -4);
  };
  for (const Neighbor& neighbor : neighbors_) {
    const Basis basis = basis_of(neighbor);
    moments += weight_of(neighbor) * basis * basis.transpose();
  }
  moments.diagonal().array() += kStiffness * moments.trace();
  const Eigen::LDLT<Moments> solver(moments);
  for (Neighbor& neighbor : neighbors_) {
    const Basis share = solver.solve(weight_of(neighbor) * basis_of(neighbor));
    std::copy(share.begin(), share.end(), neighbor.share.begin());
  }
}

double MaterialChart::share_at(const Neighbor& neighbor, const Vec3& offset) const {
  const Basis basis = basis_at(u_axis_.dot(offset) / radius_, v_axis_.dot(offset) / radius_);
  return Eigen::Map<const Basis>(neighbor.share.data()).dot(basis);
}

Vec3 MaterialChart::on_surface(const Vec3& x) const {
  if (neighbors_.empty()) return x;
  const Vec3 offset = x - positions_[vertex_];
  double height = 0;
  for (const Neighbor& neighbor : neighbors_) height += share_at(neighbor, offset) * normal_.dot(neighbor.offset);
  return x + (height - normal_.dot(offset)) * normal_;
}

Vec3 MaterialChart::place_at(const Vec3& x, const std::vector<Vec3>& places) const {
  const Vec3& home = places[vertex_];
  if (neighbors_.empty()) return home;
  Vec3 u_now = Vec3::Zero(), v_now = Vec3::Zero(), u_then = Vec3::Zero(), v_then = Vec3::Zero();
  for (const auto& [other, offset, share] : neighbors_) {
    const Vec3 offset_then = places[other] - home;
    u_now += share[0] * offset;
    v_now += share[1] * offset;
    u_then += share[0] * offset_then;
    v_then += share[1] * offset_then;
  }
  const Mat3 now = frame_of(u_now, v_now);
  if (now.col(2).isZero()) return home;
  const Mat3 map = frame_of(u_then, v_then) * now.inverse();
  const Vec3 moved = x - positions_[vertex_];
  Vec3 place = home + map * moved;
  double reach = 0;  // of what the neighbours know; beyond it the fit only guesses
  for (const Neighbor& neighbor : neighbors_) {
    place += share_at(neighbor, moved) * (places[neighbor.vertex] - home - map * neighbor.offset);
    reach = std::max(reach, (places[neighbor.vertex] - home).norm());
  }
  return (place - home).norm() <= reach ? place : home;
}

int nearest_by_walk(const KnownSurface& surface, int start, const Vec3& x) {
  int nearest = start;
  double squared = (surface.positions[start] - x).squaredNorm();
  for (int previous = -1; previous != nearest;) {
    previous = nearest;
    for (const auto& [other, edge] : surface.adjacency.ring(previous)) {
      const double distance = (surface.positions[other] - x).squaredNorm();
      if (distance < squared) {
        squared = distance;
        nearest = other;
      }
    }
  }
  return nearest;
}

void take_material_of_new_places(const std::vector<Vec3>& before, const MeshAdjacency& adjacency, SurfaceMesh& mesh) {
  const std::vector<Vec3> normals = vertex_normals(before, mesh.triangles);
  const KnownSurface surface{before, adjacency, normals};
  std::vector<std::pair<std::vector<Vec3>*, std::vector<Vec3>>> all;
  for_each_material(mesh, [&](auto& places) { all.emplace_back(&places, places); });
#pragma omp parallel for schedule(dynamic, 256)
  for (std::ptrdiff_t v = 0; v < std::ssize(before); ++v) {
    const Vec3& x = mesh.positions[v];
    const auto ring = adjacency.ring(static_cast<int>(v));
    if (ring.empty() || (x - before[v]).norm() <= kUnmoved * (before[ring[0].vertex] - before[v]).norm()) continue;
    const int home = nearest_by_walk(surface, static_cast<int>(v), x);
    const MaterialChart chart(surface, home, all.front().second);
    for (auto& [places, old] : all) (*places)[v] = chart.place_at(x, old);
  }
}

}  // namespace flowskin::tracking
