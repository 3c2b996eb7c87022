// Small meshes and set-ups that several tests of the solver use.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>

#include "sph/solver.h"

namespace flowskin::sph {

inline void add_quad(TriangleMesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const int first = static_cast<int>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), {a, b, c, d});
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

/// A horizontal square sheet of the given height, edge 2 * half, around the y axis.
inline TriangleMesh sheet(double half, double height) {
  TriangleMesh mesh;
  add_quad(mesh, {-half, height, -half}, {-half, height, half}, {half, height, half}, {half, height, -half});
  return mesh;
}

/// The six faces of a box, outward.
inline TriangleMesh closed_box(const Vec3& a, const Vec3& b) {
  TriangleMesh mesh;
  mesh.positions = {{a[0], a[1], a[2]}, {b[0], a[1], a[2]}, {b[0], b[1], a[2]}, {a[0], b[1], a[2]},
                    {a[0], a[1], b[2]}, {b[0], a[1], b[2]}, {b[0], b[1], b[2]}, {a[0], b[1], b[2]}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4},
                    {3, 7, 6}, {3, 6, 2}, {0, 4, 7}, {0, 7, 3}, {1, 2, 6}, {1, 6, 5}};
  return mesh;
}

/// A closed wall that holds fluid.
inline Boundary tank(TriangleMesh mesh, double slip) {
  Boundary wall{std::move(mesh), slip};
  wall.hollow = true;
  return wall;
}

/// A sphere of the given number of rings.
inline TriangleMesh sphere(const Vec3& center, double radius, int rings) {
  TriangleMesh mesh;
  const int sectors = 2 * rings;
  mesh.positions.push_back(center + Vec3(0, radius, 0));
  for (int i = 1; i < rings; ++i) {
    for (int j = 0; j < sectors; ++j) {
      const double polar = M_PI * i / rings, azimuth = 2 * M_PI * j / sectors;
      mesh.positions.push_back(center + radius * Vec3(std::sin(polar) * std::cos(azimuth), std::cos(polar),
                                                      -std::sin(polar) * std::sin(azimuth)));
    }
  }
  mesh.positions.push_back(center - Vec3(0, radius, 0));
  const int last = static_cast<int>(mesh.positions.size()) - 1;
  const auto at = [&](int i, int j) { return 1 + (i - 1) * sectors + j % sectors; };
  for (int j = 0; j < sectors; ++j) {
    mesh.triangles.push_back({0, at(1, j), at(1, j + 1)});
    mesh.triangles.push_back({last, at(rings - 1, j + 1), at(rings - 1, j)});
    for (int i = 1; i + 1 < rings; ++i) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

/// A set-up with one block of fluid and no walls.
inline SimulationSetup block_setup(double spacing, const Vec3& min, const Vec3& max) {
  SimulationSetup setup;
  setup.settings.spacing = spacing;
  FluidBody body;
  body.block = {min, max};
  setup.bodies.push_back(body);
  return setup;
}

/// Numbers in [0, 1) from a fixed seed; std::uniform_real_distribution differs between libraries.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double operator()() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  Vec3 vector() {
    const double x = (*this)(), y = (*this)(), z = (*this)();
    return {x, y, z};
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace flowskin::sph
