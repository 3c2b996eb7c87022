// Meshes and moving bodies for the tests of the mesh half of the tracker.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "tests/tracking/field_test_bodies.h"
#include "tracking/extraction/marching_cubes.h"
#include "tracking/field/metaballs/metaball_field.h"
#include "tracking/particles.h"

namespace flowskin::tracking::test {

/// All messages in one, to be shown by a failing test.
inline std::string joined(const std::vector<std::string>& messages) {
  std::string all;
  for (const std::string& message : messages) all += message + "\n";
  return all;
}

inline SurfaceGeometry tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

/// Adds the triangles of a grid of n x n squares whose (n + 1) x (n + 1) vertices, row by row, begin at `first`. They
/// look along (from row to row) x (along the row).
inline void add_grid_triangles(int first, int n, std::vector<Triangle>& triangles) {
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const int a = first + i * (n + 1) + j, b = a + n + 1;
      triangles.push_back({a, b, b + 1});
      triangles.push_back({a, b + 1, a + 1});
    }
  }
}

/// Two surfaces side by side in one.
inline SurfaceGeometry both(SurfaceGeometry first, const SurfaceGeometry& second) {
  const int offset = static_cast<int>(first.positions.size());
  first.positions.insert(first.positions.end(), second.positions.begin(), second.positions.end());
  for (const auto& [a, b, c] : second.triangles) first.triangles.push_back({a + offset, b + offset, c + offset});
  return first;
}

/// Turned inside out.
inline SurfaceGeometry flipped(SurfaceGeometry surface) {
  for (auto& [a, b, c] : surface.triangles) std::swap(b, c);
  return surface;
}

/// The function on a dense grid around the origin that reaches `half_width` to all sides; marched.
inline SurfaceGeometry marched(const ScalarFunction& function, double half_width, double spacing) {
  const int count = static_cast<int>(std::ceil(half_width / spacing)) * 2 + 3;
  // A helper grid tells where nodes are; the surface is moved back to the origin afterwards.
  const Vec3 shift = -0.5 * (count - 1) * spacing * Vec3::Ones();
  std::vector<double> values(static_cast<std::size_t>(count) * count * count, -1.0);
  const SparseGrid places = SparseGrid::of_values({1, 1, 1}, {-1.0}, -1.0, spacing);
  std::size_t next = 0;
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < count; ++j) {
      for (int k = 0; k < count; ++k) values[next++] = function(places.position({i, j, k}) + shift);
    }
  }
  const SparseGrid grid = SparseGrid::of_values({count, count, count}, values, -1.0, spacing);
  SurfaceGeometry surface = march(grid, [&](const Vec3& x) { return function(x + shift); });
  for (Vec3& x : surface.positions) x += shift;
  return surface;
}

/// Particles at rest positions, ids from 0.
inline Particles particles_at(std::vector<Vec3> positions) {
  Particles particles;
  for (std::size_t i = 0; i < positions.size(); ++i) particles.ids.push_back(i);
  particles.velocities.assign(positions.size(), Vec3::Zero());
  particles.rest_positions = positions;
  particles.positions = std::move(positions);
  return particles;
}

/// A ball of jittered particles of spacing 1.
inline std::vector<Vec3> ball_of_particles(double radius, const Vec3& center = Vec3::Zero(), std::uint64_t seed = 11) {
  std::vector<Vec3> points =
      lattice(1.0, static_cast<int>(radius) + 1, 0.1, seed, [&](const Vec3& x) { return x.norm() <= radius; });
  for (Vec3& point : points) point += center;
  return points;
}

/// Rotation by the vector `spin` (rad) around the origin, and a velocity field omega x x.
inline Mat3 rotation(const Vec3& spin) {
  const double angle = spin.norm();
  return angle > 0 ? Eigen::AngleAxisd(angle, spin / angle).toRotationMatrix() : Mat3::Identity();
}

/// Particles moved rigidly: rotation spin * t about the origin and translation drift * t.
inline Particles rigidly_moved(const std::vector<Vec3>& start, const Vec3& spin, const Vec3& drift, double t) {
  Particles particles = particles_at(start);
  particles.time = t;
  for (std::size_t i = 0; i < start.size(); ++i) {
    const Vec3 turned = rotation(spin * t) * start[i];
    particles.positions[i] = turned + drift * t;
    particles.velocities[i] = spin.cross(turned) + drift;
  }
  return particles;
}

}  // namespace flowskin::tracking::test
