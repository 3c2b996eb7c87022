#include "tools/textures/texture_mapping.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/textures/perceptual_color.h"
#include "tracking/mesh/mesh_measures.h"

namespace flowskin::tools {
namespace {

using Vec2d = Eigen::Vector2d;

constexpr double kTilesAcross = 2;  ///< Copies of the image along the body's longest edge, where no size is given.

/// Directions in which u and v grow, and the one from which the texture is seen unmirrored: right x up = out.
struct Chart {
  Vec3 right, up, out;
};

/// Up is y as far as possible; seen from above or below it is -z or z, so that the chart turns with the camera.
Chart chart_seen_from(const Vec3& out) {
  const Vec3 up_hint = std::abs(out.y()) < 0.9 ? Vec3(0, 1, 0) : Vec3(0, 0, out.y() > 0 ? -1 : 1);
  const Vec3 right = up_hint.cross(out).normalized();
  return {right, out.cross(right), out};
}

Vec3 unit_axis(const scenes::TextureSpec& texture) {
  const double length = texture.axis.norm();
  return length > 0 && std::isfinite(length) ? Vec3(texture.axis / length) : Vec3::UnitY();
}

double tile_size(const scenes::TextureSpec& texture, const RestFrame& rest) {
  return texture.tile_size > 0 ? texture.tile_size : rest.size / kTilesAcross;
}

Vec2f project(const Vec3& rest_position, const Chart& chart, const RestFrame& rest, double tile) {
  const Vec3 p = (rest_position - rest.center) / tile;
  return Vec2d(p.dot(chart.right), p.dot(chart.up)).cast<float>();
}

/// The chart of the coordinate axis that is nearest to `normal`.
Chart box_chart(const Vec3& normal) {
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  Vec3 out = Vec3::Zero();
  out[axis] = normal[axis] < 0 ? -1 : 1;
  return chart_seen_from(out);
}

/// Normals at rest of each triangle (length twice its area); the present ones where the rest triangle has no area.
std::vector<Vec3> rest_normals(const tracking::SurfaceMesh& mesh, const std::vector<Vec3>& places) {
  std::vector<Vec3> normals;
  normals.reserve(mesh.triangles.size());
  for (const tracking::Triangle& t : mesh.triangles) {
    const Vec3 normal = doubled_area_vector(places, t);
    double longest = 0;
    for (int k = 0; k < 3; ++k) longest = std::max(longest, (places[t[k]] - places[t[(k + 1) % 3]]).squaredNorm());
    normals.push_back(normal.norm() > 1e-9 * longest ? normal : doubled_area_vector(mesh.positions, t));
  }
  return normals;
}

/// Sum of the rest normals of the triangles around each vertex.
std::vector<Vec3> vertex_rest_normals(const tracking::SurfaceMesh& mesh, const std::vector<Vec3>& triangle_normals) {
  std::vector<Vec3> sums(mesh.positions.size(), Vec3::Zero());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (const int vertex : mesh.triangles[i]) sums[vertex] += triangle_normals[i];
  return sums;
}

/// Longitude and latitude about the pole, as texture coordinates. A whole number of tiles goes round the equator.
class SphericalMap {
 public:
  SphericalMap(const scenes::TextureSpec& texture, const RestFrame& rest) : rest_(rest), pole_(unit_axis(texture)) {
    east_ = chart_seen_from(pole_).right;
    north_ = pole_.cross(east_);
    const double radius = rest.size / 2, tile = tile_size(texture, rest);
    tiles_round_ = std::max(1.0, std::round(2 * std::numbers::pi * radius / tile));
    tiles_per_radian_ = radius / tile;
  }

  double tiles_round() const { return tiles_round_; }
  bool at_pole(const Vec3& rest_position) const {
    const Vec3 p = rest_position - rest_.center;
    return p.cross(pole_).norm() <= 1e-9 * rest_.size;
  }
  /// u from -tiles_round/2 to tiles_round/2
  Vec2d uv(const Vec3& rest_position) const {
    const Vec3 p = rest_position - rest_.center;
    const double x = p.dot(east_), y = p.dot(north_);
    return {tiles_round_ * std::atan2(y, x) / (2 * std::numbers::pi),
            tiles_per_radian_ * std::atan2(p.dot(pole_), std::hypot(x, y))};
  }

 private:
  RestFrame rest_;
  Vec3 pole_, east_, north_;
  double tiles_round_ = 1, tiles_per_radian_ = 1;
};

/// Corners beyond the seam continue u past the end; a corner at a pole takes the middle longitude of the other two.
std::array<Vec2f, 3> spherical_corners(const std::vector<Vec3>& places, const tracking::Triangle& t,
                                       const SphericalMap& map) {
  std::array<Vec2d, 3> uv;
  double largest = -map.tiles_round();
  for (int k = 0; k < 3; ++k) {
    uv[k] = map.uv(places[t[k]]);
    if (!map.at_pole(places[t[k]])) largest = std::max(largest, uv[k].x());
  }
  double sum = 0;
  int others = 0;
  for (int k = 0; k < 3; ++k) {
    if (map.at_pole(places[t[k]])) continue;
    if (uv[k].x() < largest - map.tiles_round() / 2) uv[k].x() += map.tiles_round();
    sum += uv[k].x();
    ++others;
  }
  for (int k = 0; k < 3; ++k)
    if (others > 0 && map.at_pole(places[t[k]])) uv[k].x() = sum / others;
  return {uv[0].cast<float>(), uv[1].cast<float>(), uv[2].cast<float>()};
}

/// x itself from 0 to 1, mirrored again and again beyond: for material that an emitter poured in later.
double fold(double x) { return std::abs(std::remainder(x, 2.0)); }

}  // namespace

RestFrame rest_frame(const std::vector<Vec3>& rest_positions) {
  RestFrame rest;
  if (rest_positions.empty()) return rest;
  Vec3 low = rest_positions[0], high = rest_positions[0];
  for (const Vec3& x : rest_positions) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  rest.center = (low + high) / 2;
  const double size = (high - low).maxCoeff();
  if (size > 0) rest.size = size;
  rest.height = high.y() - low.y();
  return rest;
}

std::vector<std::array<Vec2f, 3>> corner_uvs(const tracking::SurfaceMesh& mesh, const std::vector<Vec3>& places,
                                             const scenes::TextureSpec& texture, const RestFrame& rest) {
  std::vector<std::array<Vec2f, 3>> uvs;
  uvs.reserve(mesh.triangles.size());
  if (texture.mapping == "spherical") {
    const SphericalMap map(texture, rest);
    for (const tracking::Triangle& t : mesh.triangles) uvs.push_back(spherical_corners(places, t, map));
    return uvs;
  }
  const double tile = tile_size(texture, rest);
  const auto projected = [&](const tracking::Triangle& t, const Chart& chart) -> std::array<Vec2f, 3> {
    return {project(places[t[0]], chart, rest, tile), project(places[t[1]], chart, rest, tile),
            project(places[t[2]], chart, rest, tile)};
  };
  if (texture.mapping == "planar") {
    const Chart chart = chart_seen_from(unit_axis(texture));
    for (const tracking::Triangle& t : mesh.triangles) uvs.push_back(projected(t, chart));
    return uvs;
  }
  const std::vector<Vec3> normals = rest_normals(mesh, places);
  const std::vector<Vec3> around = vertex_rest_normals(mesh, normals);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    // The neighbours have a say, lest single triangles fall out of their chart where the surface is rough.
    const tracking::Triangle& t = mesh.triangles[i];
    const Vec3 normal = 6 * normals[i] + around[t[0]] + around[t[1]] + around[t[2]];
    uvs.push_back(projected(t, box_chart(normal)));
  }
  return uvs;
}

std::vector<Vec2f> vertex_uvs(const tracking::SurfaceMesh& mesh, const std::vector<Vec3>& places,
                              const scenes::TextureSpec& texture, const RestFrame& rest) {
  std::vector<Vec2f> uvs;
  uvs.reserve(mesh.positions.size());
  if (texture.mapping == "spherical") {
    const SphericalMap map(texture, rest);
    for (const Vec3& x : places) uvs.push_back(map.uv(x).cast<float>());
    return uvs;
  }
  const double tile = tile_size(texture, rest);
  if (texture.mapping == "planar") {
    const Chart chart = chart_seen_from(unit_axis(texture));
    for (const Vec3& x : places) uvs.push_back(project(x, chart, rest, tile));
    return uvs;
  }
  const std::vector<Vec3> around = vertex_rest_normals(mesh, rest_normals(mesh, places));
  for (std::size_t i = 0; i < places.size(); ++i) uvs.push_back(project(places[i], box_chart(around[i]), rest, tile));
  return uvs;
}

std::vector<std::array<Vec2f, 3>> corner_uvs(const tracking::SurfaceMesh& mesh, const scenes::TextureSpec& texture,
                                             const RestFrame& rest) {
  return corner_uvs(mesh, mesh.rest_positions, texture, rest);
}

std::vector<Vec2f> vertex_uvs(const tracking::SurfaceMesh& mesh, const scenes::TextureSpec& texture,
                              const RestFrame& rest) {
  return vertex_uvs(mesh, mesh.rest_positions, texture, rest);
}

Color rest_color(const Vec3& rest_position, const RestFrame& rest) {
  // Layers: hue and lightness rise with the height at rest, dark blue at the bottom, yellow on top. Blocks of an eighth
  // of the body, light and dark in turn, tell material at the same height apart; tanh() keeps their edges soft.
  const Vec3 p = (rest_position - rest.center) / rest.size;
  const double height = fold(p.y() * rest.size / (rest.height > 0 ? rest.height : rest.size) + 0.5);
  const auto wave = [](double x) { return std::cos(8 * std::numbers::pi * x); };
  const double blocks = std::tanh(4 * wave(p.x()) * wave(p.y()) * wave(p.z()));
  const double hue = 0.76 - 0.50 * height + 0.10 * (fold(p.x() + 0.5) - 0.5);
  return encode_srgb(linear_from_oklch(0.42 + 0.38 * height + 0.09 * blocks, 0.155, hue));
}

SurfaceFrame dress(const tracking::SurfaceMesh& mesh, double time, const scenes::TextureSpec& texture,
                   const RestFrame& rest) {
  SurfaceFrame frame;
  frame.time = time;
  frame.mesh = mesh;
  frame.normals = tracking::vertex_normals(mesh.positions, mesh.triangles);
  frame.vertex_uvs = vertex_uvs(mesh, texture, rest);
  frame.corner_uvs = corner_uvs(mesh, texture, rest);
  frame.colors.reserve(mesh.rest_positions.size());
  for (const Vec3& x : mesh.rest_positions) frame.colors.push_back(rest_color(x, rest));
  return frame;
}

ParticleFrame dress(const scenes::ParticleState& state, double spacing, const RestFrame& rest) {
  ParticleFrame frame;
  frame.state = state;
  frame.radius = spacing / 2;
  frame.colors.reserve(state.rest_positions.size());
  for (const Vec3& x : state.rest_positions) frame.colors.push_back(rest_color(x, rest));
  return frame;
}

}  // namespace flowskin::tools
