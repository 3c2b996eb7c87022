#include "tracking/fairing/fairing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace flowskin::tracking {
namespace {

constexpr double kLargestMove = 0.25;  // of the shortest edge at the vertex
constexpr double kDamping = 0.1;       // keeps the stiffness invertible where all springs lie along one line

using Vec2 = Eigen::Vector2d;

Vec2 laid(const Vec3& spring, const Eigen::Matrix<double, 3, 2>& plane, Laying laying) {
  const Vec2 projected = plane.transpose() * spring;
  if (laying == Laying::projected) return projected;
  const double length = projected.norm();
  return length > 0 ? Vec2(spring.norm() / length * projected) : projected;
}

// A spring of a vertex in its tangent plane.
struct Spring {
  Vec2 to_other;
  double length, rest_length;
};

struct RingSums {
  double length = 0, rest_length = 0;
  double shortest = std::numeric_limits<double>::max();  // squared, in space
};

// Newton's step to equilibrium: force / stiffness, both sums over the springs.
Vec2 step_to_equilibrium(const std::vector<Spring>& springs, double scale) {
  Vec2 force = Vec2::Zero();
  double xx = kDamping, xy = 0, yy = kDamping;  // the stiffness
  for (const Spring& spring : springs) {
    if (spring.length <= 0) continue;
    const double per_length = 1 / spring.length;
    const Vec2 direction = per_length * spring.to_other;
    const double strain = 1 - scale * spring.rest_length * per_length;
    force += strain * spring.to_other;
    const double across = std::max(0.0, strain), more_along = 1 - across;
    xx += across + more_along * direction.x() * direction.x();
    xy += more_along * direction.x() * direction.y();
    yy += across + more_along * direction.y() * direction.y();
  }
  return Vec2(yy * force.x() - xy * force.y(), xx * force.y() - xy * force.x()) / (xx * yy - xy * xy);
}

// The rings of a mesh with its vertices numbered along the curve of the neighbourhoods, so that what an iteration
// reads lies side by side in memory. Springs keep their order within a ring; each end of an edge has its own.
struct SpringsInOrder {
  SpringsInOrder(const MeshAdjacency& mesh, const std::vector<double>& lengths, const Neighborhoods& neighborhoods) {
    topology.neighbor_begin.reserve(neighborhoods.order().size() + 1);
    topology.neighbor_begin.push_back(0);
    topology.neighbors.reserve(mesh.neighbors.size());
    rest_lengths.reserve(mesh.neighbors.size());
    for (const int vertex : neighborhoods.order()) {
      for (const auto& [other, edge] : mesh.ring(vertex)) {
        topology.neighbors.push_back({neighborhoods.places()[other], static_cast<int>(rest_lengths.size())});
        rest_lengths.push_back(lengths[edge]);
      }
      topology.neighbor_begin.push_back(static_cast<int>(topology.neighbors.size()));
    }
  }
  MeshAdjacency topology;            // the rings alone
  std::vector<double> rest_lengths;  // m
};

// What is left of a move where the velocity is known.
Vec3 softened(const Vec3& move, const Confidence& confidence) {
  const Vec3& weak = confidence.weak_direction;
  const Vec3 along = weak * weak.dot(move);
  return (1 - confidence.weak) * along + (1 - confidence.strong) * (move - along);
}

}  // namespace

Vec3 fairing_move(const SpringMesh& mesh, int vertex, const Vec3& normal, const std::vector<Vec3>& positions) {
  const auto ring = mesh.topology.ring(vertex);
  if (ring.empty() || normal.isZero()) return Vec3::Zero();
  Eigen::Matrix<double, 3, 2> plane;
  plane.col(0) = normal.unitOrthogonal();
  plane.col(1) = normal.cross(plane.col(0));

  thread_local std::vector<Spring> springs;
  springs.clear();
  RingSums sums;
  for (const auto& [other, edge] : ring) {
    const Vec3 spring = positions[other] - positions[vertex];
    const Vec2 in_plane = laid(spring, plane, mesh.laying);
    springs.push_back({in_plane, in_plane.norm(), mesh.rest_lengths[edge]});
    sums.length += springs.back().length;
    sums.rest_length += springs.back().rest_length;
    sums.shortest = std::min(sums.shortest, spring.squaredNorm());
  }
  const double scale = sums.rest_length > sums.length ? sums.length / sums.rest_length : 1.0;
  Vec2 move = mesh.stiffness * step_to_equilibrium(springs, scale);
  const double limit = kLargestMove * std::sqrt(sums.shortest), length = move.norm();
  if (length > limit) move *= limit / length;
  return plane * move;
}

void fair(const ImplicitField& field, const MeshAdjacency& topology, const std::vector<double>& rest_lengths,
          const FairingSettings& settings, const std::vector<Confidence>& confidence, std::vector<Vec3>& positions) {
  fair(Neighborhoods(field, positions, usual_slack(field.scale())), topology, rest_lengths, settings, confidence,
       positions);
}

void fair(const Neighborhoods& neighborhoods, const MeshAdjacency& topology, const std::vector<double>& rest_lengths,
          const FairingSettings& settings, const std::vector<Confidence>& confidence, std::vector<Vec3>& positions) {
  const double longest_step = default_projection(neighborhoods.field().scale()).max_step;
  const SpringsInOrder springs(topology, rest_lengths, neighborhoods);
  const SpringMesh mesh{springs.topology, springs.rest_lengths, confidence.empty() ? Laying::projected : Laying::turned,
                        settings.stiffness};
  const std::vector<int>& places = neighborhoods.places();
  // From here on, vertices are numbered by their places.
  std::vector<Vec3> current(positions.size()), moved(positions.size()), normals(positions.size());
  neighborhoods.for_each([&](int vertex, const LocalField& local) {
    current[places[vertex]] = positions[vertex];
    normals[places[vertex]] = surface_distance(local, positions[vertex]).normal;
  });
  for (int iteration = 0; iteration < settings.iterations; ++iteration) {
    neighborhoods.for_each([&](int vertex, const LocalField& local) {
      const int v = places[vertex];
      Vec3 move = fairing_move(mesh, v, normals[v], current);
      if (!confidence.empty()) move = softened(move, confidence[vertex]);
      moved[v] = current[v] + move;
      Vec3 gradient = Vec3::Zero();
      const double f = local.value(moved[v], gradient);
      const double slope = gradient.norm();
      // One step of [FMM13, Eq. 12]; a vertex that would be thrown off the surface stays where it is.
      if (!(std::abs(f) <= longest_step * slope) || slope <= 0) {
        moved[v] = current[v];
        return;
      }
      moved[v] -= f / (slope * slope) * gradient;
      normals[v] = -gradient / slope;
    });
    current.swap(moved);
  }
  for (std::size_t vertex = 0; vertex < positions.size(); ++vertex) positions[vertex] = current[places[vertex]];
}

}  // namespace flowskin::tracking
