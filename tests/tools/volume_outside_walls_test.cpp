// The volume of a surface without what lies within the walls.
#include "tools/pipeline/volume_outside_walls.h"

#include <gtest/gtest.h>

#include "tracking/mesh/mesh_measures.h"

namespace flowskin::tools::volume_outside_walls_test {
namespace {

using sph::TriangleMesh;

// A closed box, counter-clockwise from outside.
TriangleMesh box(const Vec3& low, const Vec3& high) {
  TriangleMesh mesh;
  for (int k = 0; k < 8; ++k)
    mesh.positions.emplace_back(k & 1 ? high.x() : low.x(), k & 2 ? high.y() : low.y(), k & 4 ? high.z() : low.z());
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

scenes::Scene scene_with(const TriangleMesh& wall, const sph::BoundaryMotion& motion = {}) {
  scenes::Scene scene;
  scene.particles.spacing = 0.1;
  scenes::BoundarySpec boundary;
  boundary.boundary.mesh = wall;
  boundary.boundary.motion = motion;
  scene.boundaries.push_back(boundary);
  return scene;
}

/// A film of 1 x 0.16 x 1 on the plane y = 0, whose underside lies 0.04 within the wall.
tracking::SurfaceMesh film() {
  const TriangleMesh shape = box({0, -0.04, 0}, {1, 0.16, 1});
  tracking::SurfaceMesh mesh;
  mesh.positions = shape.positions;
  mesh.triangles = shape.triangles;
  return mesh;
}

TEST(VolumeOutsideWalls, LeavesOutWhatLiesWithinAWall) {
  EXPECT_NEAR(tracking::mesh_volume(film().positions, film().triangles), 0.2, 1e-12);
  const WallSolids floor(scene_with(box({-1, -1, -1}, {2, 0, 2})));
  EXPECT_NEAR(floor.volume_outside(film(), 0), 0.16, 1e-12);
}

TEST(VolumeOutsideWalls, AWallAwayFromTheFluidAndAnOpenSheetChangeNothing) {
  EXPECT_NEAR(WallSolids(scene_with(box({-1, -2, -1}, {2, -1, 2}))).volume_outside(film(), 0), 0.2, 1e-12);
  TriangleMesh sheet = box({-1, -1, -1}, {2, 0, 2});
  sheet.triangles.pop_back();
  EXPECT_NEAR(WallSolids(scene_with(sheet)).volume_outside(film(), 0), 0.2, 1e-12);
}

TEST(VolumeOutsideWalls, TheInsideOfAHollowWallIsOutside) {
  scenes::Scene scene = scene_with(box({-1, -1, -1}, {2, 0, 2}));
  scene.boundaries[0].boundary.hollow = true;
  EXPECT_NEAR(WallSolids(scene).volume_outside(film(), 0), 0.2, 1e-12);
}

TEST(VolumeOutsideWalls, GoesWithAMovingWall) {
  sph::BoundaryMotion rises;
  rises.keyframes = {{0, {0, -1, 0}, Vec3::Zero()}, {1, {0, 0, 0}, Vec3::Zero()}};
  const WallSolids floor(scene_with(box({-1, -1, -1}, {2, 0, 2}), rises));
  EXPECT_NEAR(floor.volume_outside(film(), 0), 0.2, 1e-12);
  EXPECT_NEAR(floor.volume_outside(film(), 1), 0.16, 1e-12);
}

}  // namespace
}  // namespace flowskin::tools::volume_outside_walls_test
