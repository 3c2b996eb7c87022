#include "scenes/sources/body_particles.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

namespace flowskin::scenes {
namespace {

/// Calls visit(point) for the lattice of cell middles that covers a box, centred in it, z fastest.
template <class Visit>
void for_each_lattice_point(const sph::Box& box, double spacing, Visit visit) {
  const Vec3 extent = box.max - box.min;
  std::array<int, 3> count{};
  for (int axis = 0; axis < 3; ++axis) {
    count[static_cast<std::size_t>(axis)] = std::max(1, static_cast<int>(std::lround(extent[axis] / spacing)));
  }
  const Vec3 first = 0.5 * (box.min + box.max) - 0.5 * spacing * Vec3(count[0] - 1, count[1] - 1, count[2] - 1);
  for (int i = 0; i < count[0]; ++i) {
    for (int j = 0; j < count[1]; ++j) {
      for (int k = 0; k < count[2]; ++k) visit(Vec3(first + spacing * Vec3(i, j, k)));
    }
  }
}

sph::Box bounding_box(const sph::TriangleMesh& mesh) {
  sph::Box box{mesh.positions.front(), mesh.positions.front()};
  for (const Vec3& p : mesh.positions) {
    box.min = box.min.cwiseMin(p);
    box.max = box.max.cwiseMax(p);
  }
  return box;
}

/// How often the surface winds around a point: the sum of the triangles' solid angles [Van Oosterom and Strackee 1983]
/// over 4 pi; 1 inside a closed mesh, 0 outside.
double winding_number(const sph::TriangleMesh& mesh, const Vec3& point) {
  double angle = 0;
  for (const auto& triangle : mesh.triangles) {
    const Vec3 a = mesh.positions[static_cast<std::size_t>(triangle[0])] - point;
    const Vec3 b = mesh.positions[static_cast<std::size_t>(triangle[1])] - point;
    const Vec3 c = mesh.positions[static_cast<std::size_t>(triangle[2])] - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle / (4 * 3.14159265358979323846);
}

void append_body(const sph::FluidBody& body, double spacing, std::vector<Vec3>& points) {
  switch (body.shape) {
    case sph::FluidBody::Shape::block:
      for_each_lattice_point(body.block, spacing, [&](const Vec3& x) { points.push_back(x); });
      break;
    case sph::FluidBody::Shape::ball: {
      const Vec3 corner = Vec3::Constant(body.radius);
      for_each_lattice_point({body.center - corner, body.center + corner}, spacing, [&](const Vec3& x) {
        if ((x - body.center).norm() <= body.radius) points.push_back(x);
      });
      break;
    }
    case sph::FluidBody::Shape::mesh:
      if (body.mesh.positions.empty()) break;
      for_each_lattice_point(bounding_box(body.mesh), spacing, [&](const Vec3& x) {
        if (winding_number(body.mesh, x) > 0.5) points.push_back(x);
      });
      break;
  }
}

/// Between -1 and 1, from the generator's 53 highest bits: the same with every standard library.
double random_share(std::mt19937_64& generator) { return 2 * (static_cast<double>(generator() >> 11) * 0x1p-53) - 1; }

}  // namespace

std::vector<Vec3> body_particles(const Scene& scene) {
  std::vector<Vec3> points;
  for (const BodySpec& body : scene.bodies) append_body(body.body, scene.particles.spacing, points);
  const double jitter = scene.particles.jitter * scene.particles.spacing;
  if (jitter == 0) return points;
  std::mt19937_64 generator(scene.seed);
  for (Vec3& point : points) {
    for (int axis = 0; axis < 3; ++axis) point[axis] += jitter * random_share(generator);
  }
  return points;
}

}  // namespace flowskin::scenes
