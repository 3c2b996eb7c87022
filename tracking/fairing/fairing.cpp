#include "tracking/fairing/fairing.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace flowskin::tracking {
namespace {

constexpr double kLargestMove = 0.25;  // of the shortest edge at the vertex
constexpr double kDamping = 0.1;       // keeps the stiffness invertible where all springs lie along one line

using Vec2 = Eigen::Vector2d;
using Mat2 = Eigen::Matrix2d;

Vec2 laid(const Vec3& spring, const Eigen::Matrix<double, 3, 2>& plane, Laying laying) {
  const Vec2 projected = plane.transpose() * spring;
  if (laying == Laying::projected) return projected;
  const double length = projected.norm();
  return length > 0 ? Vec2(spring.norm() / length * projected) : projected;
}

// The springs of one vertex in its tangent plane.
struct RingSums {
  double length = 0, rest_length = 0;
  double shortest = std::numeric_limits<double>::max();  // squared, in space
};

// Newton's step to equilibrium: force / stiffness, both sums over the springs.
Vec2 step_to_equilibrium(const SpringMesh& mesh, int vertex, const Eigen::Matrix<double, 3, 2>& plane, double scale,
                         const std::vector<Vec3>& positions) {
  Vec2 force = Vec2::Zero();
  Mat2 tangent = kDamping * Mat2::Identity();
  for (const auto& [other, edge] : mesh.topology.ring(vertex)) {
    const Vec2 spring = laid(positions[other] - positions[vertex], plane, mesh.laying);
    const double length = spring.norm();
    if (length <= 0) continue;
    const Vec2 direction = spring / length;
    const double strain = 1 - scale * mesh.rest_lengths[edge] / length;
    force += strain * spring;
    const Mat2 along = direction * direction.transpose();
    tangent += along + std::max(0.0, strain) * (Mat2::Identity() - along);
  }
  return tangent.inverse() * force;
}

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

  RingSums sums;
  for (const auto& [other, edge] : ring) {
    const Vec3 spring = positions[other] - positions[vertex];
    sums.length += laid(spring, plane, mesh.laying).norm();
    sums.rest_length += mesh.rest_lengths[edge];
    sums.shortest = std::min(sums.shortest, spring.squaredNorm());
  }
  const double scale = sums.rest_length > sums.length ? sums.length / sums.rest_length : 1.0;
  Vec2 move = mesh.stiffness * step_to_equilibrium(mesh, vertex, plane, scale, positions);
  const double limit = kLargestMove * std::sqrt(sums.shortest), length = move.norm();
  if (length > limit) move *= limit / length;
  return plane * move;
}

void fair(const MetaballField& field, const MeshTopology& topology, const std::vector<double>& rest_lengths,
          const FairingSettings& settings, const std::vector<Confidence>& confidence, std::vector<Vec3>& positions) {
  const int count = static_cast<int>(positions.size());
  std::vector<SurfaceDistance> points(count);
  const double longest_step = default_projection(field.settings()).max_step;
#pragma omp parallel for schedule(dynamic, 256)
  for (int v = 0; v < count; ++v) points[v] = surface_distance(field, positions[v]);

  const SpringMesh mesh{topology, rest_lengths, confidence.empty() ? Laying::projected : Laying::turned,
                        settings.stiffness};
  std::vector<Vec3> moved(count);
  for (int iteration = 0; iteration < settings.iterations; ++iteration) {
#pragma omp parallel for schedule(dynamic, 256)
    for (int v = 0; v < count; ++v) {
      Vec3 move = fairing_move(mesh, v, points[v].normal, positions);
      if (!confidence.empty()) move = softened(move, confidence[v]);
      moved[v] = positions[v] + move;
      Vec3 gradient = Vec3::Zero();
      const double f = field.value(moved[v], gradient);
      const double slope = gradient.norm();
      // One step of [FMM13, Eq. 12]; a vertex that would be thrown off the surface stays where it is.
      if (!(std::abs(f) <= longest_step * slope) || slope <= 0) {
        moved[v] = positions[v];
        continue;
      }
      moved[v] -= f / (slope * slope) * gradient;
      points[v].normal = -gradient / slope;
    }
    positions.swap(moved);
  }
}

}  // namespace flowskin::tracking
