// The validator must accept what is sound and name what is not.
#include "tracking/mesh/mesh_check.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/tracking/mesh_test_shapes.h"

namespace flowskin::tracking::mesh_check_test {
namespace {

using test::both;
using test::flipped;
using test::joined;
using test::tetrahedron;

std::string problems_of(const SurfaceGeometry& surface) {
  return joined(mesh_problems(surface.positions, surface.triangles));
}

SurfaceGeometry moved(SurfaceGeometry surface, double scale, const Vec3& offset) {
  for (Vec3& x : surface.positions) x = scale * x + offset;
  return surface;
}

void expect_problem(const SurfaceGeometry& surface, const std::string& words) {
  EXPECT_NE(problems_of(surface).find(words), std::string::npos)
      << "expected: " << words << "\nfound: " << problems_of(surface);
}

TEST(MeshCheck, AcceptsSoundMeshes) {
  EXPECT_EQ(problems_of({}), "");
  EXPECT_EQ(problems_of(tetrahedron()), "");
  EXPECT_EQ(problems_of(both(tetrahedron(), moved(tetrahedron(), 1, {5, 0, 0}))), "");
}

TEST(MeshCheck, AcceptsACavityInsideAPart) {
  EXPECT_EQ(problems_of(both(tetrahedron(), moved(flipped(tetrahedron()), 0.1, {0.1, 0.1, 0.1}))), "");
  // A part inside the cavity is outward again.
  const SurfaceGeometry hollow = both(tetrahedron(), moved(flipped(tetrahedron()), 0.2, {0.1, 0.1, 0.1}));
  EXPECT_EQ(problems_of(both(hollow, moved(tetrahedron(), 0.05, {0.12, 0.12, 0.12}))), "");
}

TEST(MeshCheck, NamesAPartThatIsInsideOut) {
  expect_problem(flipped(tetrahedron()), "inside out");
  expect_problem(both(tetrahedron(), moved(flipped(tetrahedron()), 1, {5, 0, 0})), "inside out");
}

TEST(MeshCheck, NamesOpenEdges) {
  SurfaceGeometry surface = tetrahedron();
  surface.triangles.pop_back();
  expect_problem(surface, "3 open edges");
}

TEST(MeshCheck, NamesEdgesInMoreThanTwoTriangles) {
  SurfaceGeometry surface = tetrahedron();
  surface.positions.emplace_back(1, 1, 1);
  surface.triangles.push_back({0, 1, 4});
  expect_problem(surface, "1 edges in more than two triangles");
}

TEST(MeshCheck, NamesTrianglesTurnedAgainstTheirNeighbors) {
  SurfaceGeometry surface = tetrahedron();
  std::swap(surface.triangles[3][0], surface.triangles[3][1]);
  expect_problem(surface, "3 edges whose two triangles are turned against each other");
}

TEST(MeshCheck, NamesVerticesWherePartsTouch) {
  SurfaceGeometry surface = both(tetrahedron(), moved(tetrahedron(), -1, {0, 0, 0}));
  surface = {surface.positions, surface.triangles};
  for (int t = 4; t < 8; ++t) std::swap(surface.triangles[t][1], surface.triangles[t][2]);  // the mirror turned it
  for (Triangle& triangle : surface.triangles) {
    for (int& vertex : triangle) vertex = vertex == 4 ? 0 : vertex > 4 ? vertex - 1 : vertex;
  }
  surface.positions.erase(surface.positions.begin() + 4);
  expect_problem(surface, "1 vertices where parts of the surface only touch");
}

TEST(MeshCheck, NamesVerticesThatAreUnreferencedOrTwice) {
  SurfaceGeometry surface = tetrahedron();
  surface.positions.emplace_back(9, 9, 9);
  expect_problem(surface, "1 unreferenced vertices, the first at vertex 4");
  expect_problem(both(tetrahedron(), moved(tetrahedron(), 1, {1, 0, 0})), "vertices at the place of another one");
}

TEST(MeshCheck, NamesBadNumbers) {
  SurfaceGeometry surface = tetrahedron();
  surface.positions[2][1] = std::numeric_limits<double>::quiet_NaN();
  expect_problem(surface, "1 vertex positions not finite, the first at vertex 2");
  surface = tetrahedron();
  surface.triangles[1][2] = 4;
  expect_problem(surface, "1 triangles with a vertex index out of range, the first at triangle 1");
  surface = tetrahedron();
  surface.triangles[1][2] = surface.triangles[1][0];
  expect_problem(surface, "1 triangles that name a vertex twice");
}

TEST(MeshCheck, NamesBadAttributes) {
  SurfaceMesh mesh;
  mesh.positions = mesh.rest_positions = tetrahedron().positions;
  mesh.triangles = tetrahedron().triangles;
  mesh.velocities.resize(4, Vec3::Zero());
  mesh.ids = {0, 1, 2, 3};
  mesh.next_id = 4;
  EXPECT_EQ(joined(mesh_problems(mesh)), "");
  mesh.ids[3] = 2;
  EXPECT_NE(joined(mesh_problems(mesh)).find("the vertex id 2 is used more than once"), std::string::npos);
  mesh.ids[3] = 7;
  EXPECT_NE(joined(mesh_problems(mesh)).find("the vertex id 7 is not below next_id"), std::string::npos);
  mesh.velocities.pop_back();
  EXPECT_NE(joined(mesh_problems(mesh)).find("3 velocities for 4 vertices"), std::string::npos);
}

}  // namespace
}  // namespace flowskin::tracking::mesh_check_test
