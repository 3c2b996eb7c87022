// The material between vertices, and that it stays where it is while vertices slide over it.
#include "tracking/material/surface_material.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/tracking/mesh_test_shapes.h"
#include "tracking/mesh/mesh_measures.h"
#include "tracking/tracker.h"

namespace flowskin::tracking::surface_material_test {
namespace {

using Map = std::function<Vec3(const Vec3&)>;

// A sphere of radius 1 about the origin whose vertices know where a map takes them.
SurfaceMesh sphere(double edge, const Map& rest) {
  const SurfaceGeometry geometry = test::marched([](const Vec3& x) { return 1 - x.norm(); }, 1.3, edge);
  SurfaceMesh mesh;
  mesh.positions = geometry.positions;
  mesh.triangles = geometry.triangles;
  for (Vec3& x : mesh.positions) x.normalize();
  for (const Vec3& x : mesh.positions) mesh.rest_positions.push_back(rest(x));
  return mesh;
}

MeshAdjacency adjacency_of(const SurfaceMesh& mesh) {
  return build_adjacency(static_cast<int>(mesh.positions.size()), mesh.triangles);
}

Vec3 bent(const Vec3& x) {
  return {x.x() + 0.2 * std::sin(2 * x.y()), 1.3 * x.y() - 0.1 * std::cos(3 * x.z()), x.z() + 0.15 * x.x() * x.y()};
}

double largest_error(const SurfaceMesh& mesh, const Map& rest) {
  double worst = 0;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    worst = std::max(worst, (mesh.rest_positions[v] - rest(mesh.positions[v])).norm());
  return worst;
}

// Each vertex along the sphere, another way than its neighbours.
void slide(double distance, const MeshAdjacency& adjacency, SurfaceMesh& mesh) {
  const std::vector<Vec3> before = mesh.positions;
  for (std::size_t v = 0; v < before.size(); ++v) {
    const Vec3 any(std::sin(7.0 * double(v)), std::cos(3.0 * double(v)), std::sin(5.0 * double(v) + 1));
    mesh.positions[v] = (before[v] + distance * before[v].cross(any).normalized()).normalized();
  }
  take_material_of_new_places(before, adjacency, mesh);
}

TEST(SurfaceMaterial, OfARigidMotionIsExactWhereverAVertexSlides) {
  const Mat3 turn = test::rotation({1, -0.4, 2});
  const Map rigid = [&](const Vec3& x) { return Vec3(turn * x + Vec3(5, -3, 1)); };
  SurfaceMesh mesh = sphere(0.2, rigid);
  mesh.layers.push_back(mesh.positions);
  slide(0.09, adjacency_of(mesh), mesh);
  EXPECT_LT(largest_error(mesh, rigid), 1e-12);
  std::swap(mesh.layers[0], mesh.rest_positions);
  EXPECT_LT(largest_error(mesh, [](const Vec3& x) { return x; }), 1e-12);
}

TEST(SurfaceMaterial, IsOfThirdOrder) {
  const auto error = [](double edge) {
    SurfaceMesh mesh = sphere(edge, bent);
    slide(0.4 * edge, adjacency_of(mesh), mesh);
    return largest_error(mesh, bent);
  };
  const double coarse = error(0.2), fine = error(0.1);
  EXPECT_LT(coarse, 0.2 * 0.02);
  EXPECT_LT(fine, coarse / 5);
}

TEST(SurfaceMaterial, IsNotSmoothedByAHundredRoundsToAndFro) {
  // The triangles of a tracked ball.
  TrackerSettings settings;
  settings.spacing = 1;
  SurfaceMesh mesh = Tracker(settings, test::particles_at(test::ball_of_particles(6.2))).mesh();
  const double spacing = 1 / (mesh.positions[0].norm()), edge = 0.75 * spacing;
  for (Vec3& x : mesh.positions) x.normalize();
  std::transform(mesh.positions.begin(), mesh.positions.end(), mesh.rest_positions.begin(), bent);
  const MeshAdjacency adjacency = adjacency_of(mesh);
  const std::vector<Vec3> home = mesh.positions;
  for (int round = 0; round < 100; ++round) {
    for (const double angle : {0.2 * edge, 0.0}) {
      const std::vector<Vec3> before = mesh.positions;
      for (std::size_t v = 0; v < home.size(); ++v) mesh.positions[v] = test::rotation({0, 0, angle}) * home[v];
      take_material_of_new_places(before, adjacency, mesh);
    }
  }
  EXPECT_EQ(mesh.positions, home);
  EXPECT_LT(largest_error(mesh, bent), 0.01 * spacing);
}

TEST(SurfaceMaterial, IsNotMixedWhereTwoBodiesHaveMet) {
  const Map torn = [](const Vec3& x) { return Vec3(x + (x.x() > 0 ? 50 : 0) * Vec3::UnitY()); };
  SurfaceMesh mesh = sphere(0.2, torn);
  slide(0.05, adjacency_of(mesh), mesh);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3 &x = mesh.positions[v], rest = mesh.rest_positions[v];
    EXPECT_LT(std::min((rest - x).norm(), (rest - x - 50 * Vec3::UnitY()).norm()), 0.2) << v;
  }
}

// A standing wave and two vortices in a block of 2 : 1 : 1; without divergence.
Vec3 sloshing(const Vec3& x, double t) {
  const double k = M_PI / 2, wave = 0.14 * std::cos(1.5 * t) / std::sinh(k);
  Vec3 u(-wave * std::cosh(k * x.y()) * std::sin(k * x.x()), wave * std::sinh(k * x.y()) * std::cos(k * x.x()), 0);
  u +=
      0.06 * Vec3(std::sin(M_PI * x.x()) * std::cos(M_PI * x.y()), -std::cos(M_PI * x.x()) * std::sin(M_PI * x.y()), 0);
  u +=
      0.05 * Vec3(std::sin(M_PI * x.x()) * std::cos(M_PI * x.z()), 0, -std::cos(M_PI * x.x()) * std::sin(M_PI * x.z()));
  return u;
}

Vec3 carried(Vec3 x, double from, double to, int steps) {
  const double h = (to - from) / steps;
  for (int step = 0; step < steps; ++step) {
    const double t = from + step * h;
    const Vec3 a = sloshing(x, t), b = sloshing(x + h / 2 * a, t + h / 2);
    const Vec3 c = sloshing(x + h / 2 * b, t + h / 2), d = sloshing(x + h * c, t + h);
    x += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return x;
}

// Median distance (spacings) between the vertices of a tracked block and where the flow takes their rest positions.
double error_of_sloshing_block(TrackerSettings settings, double* velocity_error) {
  const int n = 14;
  const double spacing = 1.0 / n, rate = 24;
  std::vector<Vec3> start;
  for (const Vec3& x : test::lattice(1.0, 2 * n, 0.2, 5, [&](const Vec3& x) {
         return (x - Vec3(n, 0.5 * n, 0.5 * n)).cwiseAbs().cwiseQuotient(Vec3(2, 1, 1)).maxCoeff() < 0.5 * n;
       }))
    start.push_back(spacing * x);
  Particles particles = test::particles_at(start);
  const auto take_velocities = [&] {
    for (std::size_t i = 0; i < start.size(); ++i)
      particles.velocities[i] = sloshing(particles.positions[i], particles.time);
  };
  take_velocities();
  settings.spacing = spacing;
  Tracker tracker(settings, particles);
  for (int frame = 1; frame <= 16; ++frame) {
    for (Vec3& x : particles.positions) x = carried(x, particles.time, frame / rate, 4);
    particles.time = frame / rate;
    take_velocities();
    tracker.advance(particles);
  }
  const SurfaceMesh& mesh = tracker.mesh();
  std::vector<double> errors;
  double squares = 0, of_truth = 0;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const auto at = [&](double time) { return carried(mesh.rest_positions[v], 0, time, 64); };
    errors.push_back((at(particles.time) - mesh.positions[v]).norm() / spacing);
    const Vec3 motion = (at(particles.time + 1e-3) - at(particles.time - 1e-3)) / 2e-3;
    squares += (mesh.velocities[v] - motion).squaredNorm();
    of_truth += motion.squaredNorm();
  }
  *velocity_error = std::sqrt(squares / of_truth);
  std::nth_element(errors.begin(), errors.begin() + std::ssize(errors) / 2, errors.end());
  return errors[errors.size() / 2];
}

TEST(SurfaceMaterial, StaysInASloshingBlock) {
  TrackerSettings settings;
  double velocity_error = 0;
  const double kept = error_of_sloshing_block(settings, &velocity_error);
  EXPECT_LT(kept, 0.025);
  // The velocity at a vertex is that of the material there, by finite differences of its path.
  EXPECT_LT(velocity_error, 0.02);
  settings.fairing_iterations = 10;
  EXPECT_LT(error_of_sloshing_block(settings, &velocity_error), 0.025);
  settings.fairing_drags = true;
  EXPECT_GT(error_of_sloshing_block(settings, &velocity_error), 2 * kept);
}

}  // namespace
}  // namespace flowskin::tracking::surface_material_test
