#include <numbers>
#include <set>

#include "tests/tools/io_fixture.h"
#include "tools/textures/texture_mapping.h"
#include "tracking/mesh/mesh_check.h"

namespace flowskin::tools::textures_mapping_test {
namespace {

scenes::TextureSpec texture_of(const std::string& mapping, double tile_size = 0, const Vec3& axis = {0, 1, 0}) {
  scenes::TextureSpec texture;
  texture.mapping = mapping;
  texture.tile_size = tile_size;
  texture.axis = axis;
  return texture;
}

Vec3 rest_normal(const tracking::SurfaceMesh& mesh, std::size_t i) {
  const auto& [a, b, c] = mesh.triangles[i];
  return (mesh.rest_positions[b] - mesh.rest_positions[a]).cross(mesh.rest_positions[c] - mesh.rest_positions[a]);
}

/// A cube from -1 to 1 whose faces are grids of n by n squares, vertices shared along the edges.
tracking::SurfaceMesh cube_mesh(int n) {
  tracking::SurfaceMesh mesh;
  std::map<std::array<int, 3>, int> found;
  const auto vertex = [&](const Eigen::Vector3i& p) {
    const auto [place, is_new] = found.try_emplace({p.x(), p.y(), p.z()}, static_cast<int>(found.size()));
    if (is_new) mesh.rest_positions.push_back(p.cast<double>() * (2.0 / n) - Vec3::Ones());
    return place->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {0, n})
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const auto corner = [&](int di, int dj) {
            Eigen::Vector3i p;
            p[axis] = side;
            p[(axis + 1) % 3] = i + di;
            p[(axis + 2) % 3] = j + dj;
            return vertex(p);
          };
          const std::array<int, 4> q{corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
          if (side == n)
            mesh.triangles.insert(mesh.triangles.end(), {{q[0], q[1], q[2]}, {q[0], q[2], q[3]}});
          else
            mesh.triangles.insert(mesh.triangles.end(), {{q[0], q[2], q[1]}, {q[0], q[3], q[2]}});
        }
  mesh.positions = mesh.rest_positions;
  mesh.velocities.assign(mesh.positions.size(), Vec3::Zero());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) mesh.ids.push_back(i);
  mesh.next_id = mesh.positions.size();
  return mesh;
}

double signed_uv_area(const std::array<Vec2f, 3>& uv) {
  const Vec2f a = uv[1] - uv[0], b = uv[2] - uv[0];
  return 0.5 * (static_cast<double>(a.x()) * b.y() - static_cast<double>(a.y()) * b.x());
}

TEST(RestFrame, IsTheBoundingBox) {
  const RestFrame rest = rest_frame({{0, 1, 2}, {1, 3, 2.5}, {0.5, 2, 2}});
  EXPECT_EQ(rest.center, Vec3(0.5, 2, 2.25));
  EXPECT_EQ(rest.size, 2);
  EXPECT_EQ(rest_frame({}).size, 1) << "never zero: it is divided by";
  EXPECT_EQ(rest_frame({{1, 1, 1}}).size, 1);
}

TEST(BoxMapping, CubeFacesAreFlatUnstretchedAndUnmirrored) {
  const tracking::SurfaceMesh cube = cube_mesh(6);
  ASSERT_TRUE(tracking::mesh_problems(cube).empty());
  const RestFrame rest = rest_frame(cube.rest_positions);
  const auto uvs = corner_uvs(cube, texture_of("box", 0.5), rest);
  std::map<std::array<int, 2>, std::map<int, Vec2f>> faces;  // axis and side, then vertex
  for (std::size_t i = 0; i < cube.triangles.size(); ++i) {
    const Vec3 normal = rest_normal(cube, i);
    // Seen from outside, u x v has the triangle's winding; one tile is 0.5 m, so areas grow by 4.
    EXPECT_NEAR(signed_uv_area(uvs[i]), 4 * normal.norm() / 2, 1e-5);
    Eigen::Index axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    for (int k = 0; k < 3; ++k) {
      const auto [place, is_new] =
          faces[{static_cast<int>(axis), normal[axis] > 0 ? 1 : 0}].try_emplace(cube.triangles[i][k], uvs[i][k]);
      EXPECT_EQ(place->second, uvs[i][k]) << "a seam inside a face of the box";
    }
  }
  EXPECT_EQ(faces.size(), 6U);
}

TEST(BoxMapping, TextStandsUprightOnTheSides) {
  const tracking::SurfaceMesh cube = cube_mesh(2);
  const auto uvs = corner_uvs(cube, texture_of("box"), rest_frame(cube.rest_positions));
  for (std::size_t i = 0; i < cube.triangles.size(); ++i) {
    const Vec3 normal = rest_normal(cube, i).normalized();
    for (int k = 0; k < 3; ++k) {
      const Vec3& p = cube.rest_positions[cube.triangles[i][k]];
      if (std::abs(normal.y()) < 0.5) {
        EXPECT_FLOAT_EQ(uvs[i][k].y(), static_cast<float>(p.y()));
      } else {
        EXPECT_FLOAT_EQ(uvs[i][k].x(), static_cast<float>(p.x()));
      }
    }
  }
}

TEST(BoxMapping, TwoTilesCrossTheBodyByDefault) {
  const tracking::SurfaceMesh cube = cube_mesh(4);
  float low = 1e9F, high = -1e9F;
  for (const auto& corners : corner_uvs(cube, texture_of("box"), rest_frame(cube.rest_positions)))
    for (const Vec2f& uv : corners) {
      low = std::min(low, uv.x());
      high = std::max(high, uv.x());
    }
  EXPECT_FLOAT_EQ(high - low, 2);
}

TEST(BoxMapping, FollowsTheMaterialNotThePresentShape) {
  tracking::SurfaceMesh mesh = sphere_mesh(2);
  const RestFrame rest = rest_frame(mesh.rest_positions);
  const auto before = corner_uvs(mesh, texture_of("box"), rest);
  for (Vec3& x : mesh.positions) x = Vec3(2 * x.y(), x.x() - 7, 0.1 * x.z() * x.z());
  EXPECT_EQ(corner_uvs(mesh, texture_of("box"), rest), before);
}

TEST(BoxMapping, ATriangleWithoutAreaAtRestTakesItsPresentNormal) {
  tracking::SurfaceMesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}};  // faces up
  mesh.rest_positions = {{0.1, 0.2, 0.3}, {0.1, 0.2, 0.3}, {0.1, 0.2, 0.3}};
  mesh.triangles = {{0, 1, 2}};
  RestFrame rest;
  rest.size = 2;
  const auto uvs = corner_uvs(mesh, texture_of("box"), rest);
  EXPECT_FLOAT_EQ(uvs[0][0].x(), 0.1F);
  EXPECT_FLOAT_EQ(uvs[0][0].y(), -0.3F);
  mesh.positions = mesh.rest_positions;  // no normal at all: still a number
  const auto shrunk = corner_uvs(mesh, texture_of("box"), rest);
  for (const Vec2f& uv : shrunk[0]) EXPECT_TRUE(uv.allFinite());
  for (const Vec2f& uv : vertex_uvs(mesh, texture_of("box"), rest)) EXPECT_TRUE(uv.allFinite());
}

TEST(PlanarMapping, IsTheProjectionAlongTheAxis) {
  const tracking::SurfaceMesh mesh = sphere_mesh(2);
  const RestFrame rest = rest_frame(mesh.rest_positions);
  for (const Vec3& axis : {Vec3(0, 1, 0), Vec3(0, -3, 0), Vec3(1, 2, -0.5), Vec3(0, 0, 0)}) {
    const auto uvs = corner_uvs(mesh, texture_of("planar", 0.25, axis), rest);
    const Vec3 out = axis.norm() > 0 ? Vec3(axis.normalized()) : Vec3::UnitY();
    for (std::size_t i = 0; i < uvs.size(); ++i)
      EXPECT_NEAR(signed_uv_area(uvs[i]), 16 * rest_normal(mesh, i).dot(out) / 2, 1e-4);
  }
}

TEST(SphericalMapping, NoTriangleIsTornAtTheSeam) {
  for (const Vec3& axis : {Vec3(0, 1, 0), Vec3(1, 0, 0), Vec3(0.3, -0.2, 0.9)}) {
    const tracking::SurfaceMesh mesh = sphere_mesh(3);
    const RestFrame rest = rest_frame(mesh.rest_positions);
    const auto uvs = corner_uvs(mesh, texture_of("spherical", 0, axis), rest);
    const Vec3 pole = axis.normalized();
    int checked = 0;
    for (std::size_t i = 0; i < uvs.size(); ++i) {
      double highest = 0;
      for (const int vertex : mesh.triangles[i])
        highest = std::max(highest, std::abs(mesh.rest_positions[vertex].dot(pole)));
      if (highest > 0.9) continue;  // the map stretches without bound at the poles
      ++checked;
      // On the unit sphere with 6 tiles round: du dv = (6 / 2 pi)(1 / tile) d(lon) d(lat), area = cos(lat) d(lon)
      // d(lat).
      const double area = signed_uv_area(uvs[i]), true_area = rest_normal(mesh, i).norm() / 2;
      EXPECT_GT(area, 0.8 * 6 / (2 * std::numbers::pi) * true_area) << i;
      EXPECT_LT(area, 3.5 * 6 / (2 * std::numbers::pi) * true_area) << i;
    }
    EXPECT_GT(checked, 300);
  }
}

TEST(SphericalMapping, SeamMeetsAtWholeTiles) {
  const tracking::SurfaceMesh mesh = sphere_mesh(3);
  const RestFrame rest = rest_frame(mesh.rest_positions);
  for (const double tile : {0.0, 0.13, 0.9, 50.0}) {
    const auto uvs = corner_uvs(mesh, texture_of("spherical", tile), rest);
    std::vector<std::set<float>> fractions(mesh.positions.size());
    for (std::size_t i = 0; i < uvs.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        const Vec3& p = mesh.rest_positions[mesh.triangles[i][k]];
        if (std::abs(p.y()) > 0.999) continue;
        const auto& all = fractions[mesh.triangles[i][k]];
        for (const float other : all) EXPECT_NEAR(std::remainder(other - uvs[i][k].x(), 1.0F), 0, 1e-5);
        fractions[mesh.triangles[i][k]].insert(uvs[i][k].x());
      }
  }
}

TEST(SphericalMapping, PolesAndCentreAreFinite) {
  tracking::SurfaceMesh mesh = sphere_mesh(1);
  mesh.rest_positions[7] = Vec3::Zero();
  const RestFrame rest;
  for (const auto& corners : corner_uvs(mesh, texture_of("spherical"), rest))
    for (const Vec2f& uv : corners) EXPECT_TRUE(uv.allFinite());
  for (const Vec2f& uv : vertex_uvs(mesh, texture_of("spherical"), rest)) EXPECT_TRUE(uv.allFinite());
}

TEST(VertexUvs, AgreeWithTheCornersAwayFromSeams) {
  const tracking::SurfaceMesh mesh = sphere_mesh(3);
  const RestFrame rest = rest_frame(mesh.rest_positions);
  for (const char* mapping : {"box", "planar", "spherical"}) {
    const auto corners = corner_uvs(mesh, texture_of(mapping), rest);
    const auto vertices = vertex_uvs(mesh, texture_of(mapping), rest);
    std::size_t equal = 0;
    for (std::size_t i = 0; i < corners.size(); ++i)
      for (int k = 0; k < 3; ++k) equal += corners[i][k] == vertices[mesh.triangles[i][k]] ? 1 : 0;
    EXPECT_GT(equal, 3 * corners.size() * 8 / 10) << mapping;
  }
}

TEST(RestColor, TellsMaterialApartAndIsNeverBlackOrWhite) {
  RestFrame rest;
  rest.size = 2;
  std::set<Color> colors;
  for (double x = -0.95; x < 1; x += 0.1)
    for (double y = -0.95; y < 1; y += 0.1)
      for (double z = -0.95; z < 1; z += 0.1) {
        const Color color = rest_color({x, y, z}, rest);
        colors.insert(color);
        EXPECT_GT(*std::max_element(color.begin(), color.end()), 60);
        EXPECT_LT(*std::min_element(color.begin(), color.end()), 200);
      }
  EXPECT_GT(colors.size(), 1000U);
}

TEST(RestColor, IsContinuousAlsoBeyondTheBody) {
  const RestFrame rest;
  for (double y = -3; y < 3; y += 0.001)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_LE(std::abs(rest_color({0.3, y, 0.2}, rest)[k] - rest_color({0.3, y + 0.001, 0.2}, rest)[k]), 12) << y;
}

TEST(Dress, AddsWhatTheWritersNeed) {
  const SurfaceFrame frame = sphere_frame(3);
  ASSERT_EQ(frame.normals.size(), frame.mesh.positions.size());
  EXPECT_EQ(frame.colors.size(), frame.mesh.positions.size());
  EXPECT_EQ(frame.vertex_uvs.size(), frame.mesh.positions.size());
  EXPECT_EQ(frame.corner_uvs.size(), frame.mesh.triangles.size());
  for (std::size_t i = 0; i < frame.normals.size(); ++i) {
    EXPECT_NEAR(frame.normals[i].norm(), 1, 1e-12);
    EXPECT_GT(frame.normals[i].dot(frame.mesh.rest_positions[i]), 0.99);
  }
  EXPECT_EQ(frame.time, 0.1);
  const ParticleFrame particles = particle_frame(5);
  EXPECT_EQ(particles.colors.size(), 5U);
  EXPECT_EQ(particles.radius, 0.01);
}

}  // namespace
}  // namespace flowskin::tools::textures_mapping_test
