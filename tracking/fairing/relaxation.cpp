#include "tracking/fairing/relaxation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "tracking/mesh/mesh_measures.h"

namespace flowskin::tracking {
namespace {

constexpr double kShare = 0.5;
constexpr double kLargestRelaxation = 0.3;  // of the shortest edge at the vertex
constexpr double kInvertedCosine = 0.2;
constexpr double kRidgeSlope = 0.05;  // slope of the volume against the normal
constexpr int kTakeBackRounds = 8;

// Six times the derivative of the enclosed volume by the position of a vertex.
Vec3 volume_gradient(int vertex, const MeshAdjacency& topology, const std::vector<Triangle>& triangles,
                     const std::vector<Vec3>& positions) {
  Vec3 sum = Vec3::Zero();
  for (int t : topology.star(vertex)) {
    const Triangle& triangle = triangles[t];
    const int corner = triangle[0] == vertex ? 0 : triangle[1] == vertex ? 1 : 2;
    const Vec3 a = positions[triangle[(corner + 1) % 3]] - positions[vertex];
    const Vec3 b = positions[triangle[(corner + 2) % 3]] - positions[vertex];
    sum += a.cross(b);
  }
  return sum;
}

// Where the surface is sharply curved, moving down from the ridge costs volume: only moves along it or up are left.
Vec3 along_ridge(const Vec3& move, const Vec3& growth, const Vec3& normal) {
  const Vec3 uphill = growth - normal * normal.dot(growth);
  const double steepness = uphill.norm();
  if (!(steepness > kRidgeSlope * growth.norm() && uphill.dot(move) < 0)) return move;
  return move - uphill * (uphill.dot(move) / (steepness * steepness));
}

// Where a vertex would go, before projection.
Vec3 relaxed_position(int vertex, const MeshAdjacency& topology, const std::vector<Triangle>& triangles,
                      const std::vector<Vec3>& positions, const Vec3& normal, Ridges ridges) {
  const Vec3& x = positions[vertex];
  Vec3 mean = Vec3::Zero();
  double shortest = std::numeric_limits<double>::max();
  const auto ring = topology.ring(vertex);
  for (const auto& [other, edge] : ring) {
    mean += positions[other] - x;
    shortest = std::min(shortest, (positions[other] - x).squaredNorm());
  }
  if (ring.empty()) return x;
  Vec3 move = kShare / static_cast<double>(ring.size()) * mean;
  move -= normal * normal.dot(move);
  if (ridges == Ridges::kept) move = along_ridge(move, volume_gradient(vertex, topology, triangles, positions), normal);
  const double limit = kLargestRelaxation * std::sqrt(shortest), length = move.norm();
  return length > limit ? Vec3(x + limit / length * move) : Vec3(x + move);
}

// The triangles that move with these vertices, ascending.
std::vector<int> triangles_at(const std::vector<int>& vertices, const MeshAdjacency& topology) {
  std::vector<int> found;
  for (int vertex : vertices) {
    for (int t : topology.star(vertex)) found.push_back(t);
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

// Takes back the moves around triangles that were upright before and are not now.
void take_back(const std::vector<Triangle>& triangles, const std::vector<int>& touched,
               const std::vector<char>& inverted_before, const std::vector<Vec3>& old_positions,
               const std::vector<Vec3>& old_normals, std::vector<Vec3>& positions, std::vector<Vec3>& normals) {
  for (int round = 0; round < kTakeBackRounds; ++round) {
    bool any = false;
    for (std::size_t i = 0; i < touched.size(); ++i) {
      const int t = touched[i];
      if (inverted_before[i] || !is_inverted(triangles[t], positions, normals)) continue;
      for (int vertex : triangles[t]) {
        any = any || positions[vertex] != old_positions[vertex];
        positions[vertex] = old_positions[vertex];
        normals[vertex] = old_normals[vertex];
      }
    }
    if (!any) return;
  }
}

}  // namespace

bool is_inverted(const Triangle& triangle, const std::vector<Vec3>& positions, const std::vector<Vec3>& normals) {
  const Vec3 area = doubled_area_vector(positions, triangle);
  const double largest =
      std::max({area.dot(normals[triangle[0]]), area.dot(normals[triangle[1]]), area.dot(normals[triangle[2]])});
  return !(largest > kInvertedCosine * area.norm());
}

void relax(const ImplicitField& field, const ProjectionSettings& projection, const MeshAdjacency& topology,
           const std::vector<Triangle>& triangles, int iterations, const std::vector<int>& vertices,
           std::vector<Vec3>& positions, std::vector<Vec3>& normals, Ridges ridges) {
  std::vector<int> moving = vertices;
  if (moving.empty()) {
    moving.resize(positions.size());
    std::iota(moving.begin(), moving.end(), 0);
  }
  const std::vector<int> touched = triangles_at(moving, topology);
  std::vector<char> inverted(touched.size());
  std::vector<Vec3> starts(moving.size());
  for (std::size_t i = 0; i < moving.size(); ++i) starts[i] = positions[moving[i]];
  const Neighborhoods neighborhoods(field, starts, usual_slack(field.scale()));
  for (int iteration = 0; iteration < iterations; ++iteration) {
    const std::vector<Vec3> old_positions = positions, old_normals = normals;
    for (std::size_t i = 0; i < touched.size(); ++i)
      inverted[i] = is_inverted(triangles[touched[i]], positions, normals);
    neighborhoods.for_each([&](int i, const LocalField& local) {
      const int vertex = moving[i];
      Vec3 x = relaxed_position(vertex, topology, triangles, old_positions, old_normals[vertex], ridges);
      SurfaceDistance point;
      if (!project_point(local, projection, x, point)) return;
      positions[vertex] = x;
      normals[vertex] = point.normal;
    });
    take_back(triangles, touched, inverted, old_positions, old_normals, positions, normals);
  }
}

}  // namespace flowskin::tracking
