#include "tracking/mesh/texture_stretch.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

namespace flowskin::tracking::mesh_texture_stretch_test {
namespace {

SurfaceMesh one_triangle() {
  SurfaceMesh mesh;
  mesh.rest_positions = {{0.1, 0.2, 0.3}, {1.3, 0.1, 0.4}, {0.4, 1.1, -0.2}};
  mesh.positions = mesh.rest_positions;
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

TEST(TextureStretch, OneForARigidMotion) {
  SurfaceMesh mesh = one_triangle();
  const Eigen::AngleAxisd turn(1.1, Vec3(1, 2, 3).normalized());
  for (Vec3& x : mesh.positions) x = turn * x + Vec3(3, -2, 1);
  const Stretch stretch = texture_stretch(mesh).front();
  EXPECT_NEAR(stretch.largest, 1, 1e-12);
  EXPECT_NEAR(stretch.smallest, 1, 1e-12);
}

TEST(TextureStretch, SingularValuesOfAStretchInThePlaneOfTheTriangle) {
  SurfaceMesh mesh = one_triangle();
  const Vec3 x = (mesh.positions[1] - mesh.positions[0]).normalized();
  const Vec3 normal = x.cross(mesh.positions[2] - mesh.positions[0]).normalized();
  const Vec3 y = normal.cross(x);
  const Mat3 map = Mat3::Identity() + 2 * x * x.transpose() - 0.5 * y * y.transpose();
  for (Vec3& p : mesh.positions) p = map * p;
  const Stretch stretch = texture_stretch(mesh).front();
  EXPECT_NEAR(stretch.largest, 3, 1e-12);
  EXPECT_NEAR(stretch.smallest, 0.5, 1e-12);
}

TEST(TextureStretch, InfiniteWhereTheMaterialHadNoArea) {
  SurfaceMesh mesh = one_triangle();
  mesh.rest_positions[2] = mesh.rest_positions[1];
  EXPECT_TRUE(std::isinf(texture_stretch(mesh).front().largest));
}

TEST(TextureStretch, OfASimpleShearFromAnyPlaces) {
  // The singular values of [1 g; 0 1] are (sqrt(g^2 + 4) +- g) / 2.
  const double shear = 3;
  SurfaceMesh mesh = one_triangle();
  std::vector<Vec3> places;
  for (Vec3& x : mesh.positions) {
    x.z() = 0;
    places.push_back(x);
    x.x() += shear * x.y();
  }
  mesh.rest_positions.assign(3, Vec3::Zero());  // not these
  const Stretch stretch = texture_stretch(mesh, places).front();
  EXPECT_NEAR(stretch.largest, (std::sqrt(13) + 3) / 2, 1e-12);
  EXPECT_NEAR(stretch.smallest, (std::sqrt(13) - 3) / 2, 1e-12);
}

TEST(TextureStretch, DistortionIsTheWorseOfStretchAndSqueeze) {
  EXPECT_EQ(distortion({3, 0.5}), 3);
  EXPECT_EQ(distortion({3, 0.25}), 4);
  EXPECT_EQ(distortion({0.5, 0.25}), 4);
  EXPECT_EQ(distortion({1, 1}), 1);
  EXPECT_TRUE(std::isinf(distortion({2, 0})));
}

}  // namespace
}  // namespace flowskin::tracking::mesh_texture_stretch_test
