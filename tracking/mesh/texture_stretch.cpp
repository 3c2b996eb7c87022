#include "tracking/mesh/texture_stretch.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace flowskin::tracking {

namespace {

using Mat2 = Eigen::Matrix2d;

/// The two edges from the first corner as columns, in an orthonormal frame of the triangle's plane.
Mat2 edges_in_plane(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 first = b - a, second = c - a;
  const double length = first.norm();
  if (length == 0) return Mat2::Zero();
  const Vec3 x = first / length;
  const double along = second.dot(x);
  return (Mat2() << length, along, 0, (second - along * x).norm()).finished();
}

Stretch stretch_of(const Mat2& rest, const Mat2& now) {
  const double area = rest.determinant();
  if (!(area > 1e-12 * rest.squaredNorm())) return {std::numeric_limits<double>::infinity(), 0};
  const Mat2 map = now * (Mat2() << rest(1, 1), -rest(0, 1), -rest(1, 0), rest(0, 0)).finished() / area;
  // Singular values of a 2x2 matrix in closed form: (p +- q) / 2.
  const double p = std::hypot(map(0, 0) + map(1, 1), map(1, 0) - map(0, 1));
  const double q = std::hypot(map(0, 0) - map(1, 1), map(1, 0) + map(0, 1));
  return {(p + q) / 2, std::abs(p - q) / 2};
}

}  // namespace

double distortion(const Stretch& stretch) {
  const double squeeze = stretch.smallest > 0 ? 1 / stretch.smallest : std::numeric_limits<double>::infinity();
  return std::max({1.0, stretch.largest, squeeze});
}

std::vector<Stretch> texture_stretch(const SurfaceMesh& mesh, const std::vector<Vec3>& places) {
  std::vector<Stretch> stretch(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    stretch[t] = stretch_of(edges_in_plane(places[a], places[b], places[c]),
                            edges_in_plane(mesh.positions[a], mesh.positions[b], mesh.positions[c]));
  }
  return stretch;
}

std::vector<Stretch> texture_stretch(const SurfaceMesh& mesh) { return texture_stretch(mesh, mesh.rest_positions); }

}  // namespace flowskin::tracking
