// Each operation on edges, and each of its vetoes.
#include "tracking/mesh/editable_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/tracking/mesh_test_shapes.h"
#include "tests/tracking/welded_box.h"
#include "tracking/mesh/mesh_check.h"
#include "tracking/mesh/mesh_measures.h"

namespace flowskin::tracking::editable_mesh_test {
namespace {

using test::joined;
using test::welded_box;

constexpr double kAny = 100;  // no edge is longer

int vertex_at(const SurfaceGeometry& surface, const Vec3& x) {
  for (std::size_t v = 0; v < surface.positions.size(); ++v) {
    if ((surface.positions[v] - x).norm() < 1e-9) return static_cast<int>(v);
  }
  return -1;
}

/// A box of 4 x 4 squares per face, and three neighbours in the middle of its upper face.
struct Box {
  SurfaceGeometry surface = welded_box(4);
  int middle = vertex_at(surface, {2, 4, 2}), beside = vertex_at(surface, {3, 4, 2}),
      above = vertex_at(surface, {2, 4, 3});
  EditableMesh mesh{surface.positions, surface.triangles};
};

TEST(EditableMesh, CollapseOnAFlatFaceKeepsTheBoxAsItIs) {
  Box box;
  ASSERT_TRUE(box.mesh.collapse(box.middle, box.beside, kAny, 1e-12));
  box.mesh.compact();
  EXPECT_EQ(joined(mesh_problems(box.surface.positions, box.surface.triangles)), "");
  EXPECT_NEAR(mesh_volume(box.surface.positions, box.surface.triangles), 64, 1e-9);
}

TEST(EditableMesh, CollapseRefusesVerticesWithoutAnEdge) {
  Box box;
  EXPECT_FALSE(box.mesh.collapse(box.middle, vertex_at(box.surface, {0, 4, 0}), kAny));
  EXPECT_FALSE(box.mesh.collapse(box.middle, box.middle, kAny));
}

TEST(EditableMesh, CollapseRefusesAnEdgeThatGrowsTooLong) {
  Box box;
  EXPECT_FALSE(box.mesh.collapse(box.middle, box.beside, 1.9));
  EXPECT_TRUE(box.mesh.collapse(box.middle, box.beside, 2.9));
}

TEST(EditableMesh, CollapseRefusesALossOfVolume) {
  Box box;
  box.surface.positions[box.beside].y() += 0.3;  // the tip of a low hill of squares: a few tenths of a unit
  EXPECT_FALSE(box.mesh.collapse(box.middle, box.beside, kAny, 0.05));
  EXPECT_TRUE(box.mesh.collapse(box.middle, box.beside, kAny, 1));
}

TEST(EditableMesh, CollapseRefusesToTurnATriangle) {
  // Over the edge of the box: triangles of the upper face would lean over, the one cut off along a diagonal most.
  for (const double y : {2.8, 2.7}) {
    Box box;
    const int side = vertex_at(box.surface, {4, 3, 2}), ridge = vertex_at(box.surface, {4, 4, 2});
    box.surface.positions[side].y() = y;
    EXPECT_EQ(box.mesh.collapse(side, ridge, kAny), std::atan(std::sqrt(2.0) * (4 - y)) < std::numbers::pi / 3) << y;
  }
}

TEST(EditableMesh, CollapseRefusesASliver) {
  // Two neighbours of the vertex that would go lie on a line with the one that would stay, or do not.
  for (const double z : {1.5, 1.0}) {
    Box box;
    box.surface.positions[vertex_at(box.surface, {1, 4, 2})] = {0.9, 4, 1.3};
    box.surface.positions[vertex_at(box.surface, {1, 4, 1})] = {1.5, 4, z};
    EXPECT_EQ(box.mesh.collapse(box.beside, box.middle, kAny), z < 1.2) << z;
  }
}

TEST(EditableMesh, CollapseKeepsTheLinkCondition) {
  // A prism of three sides: its waist of three edges bounds no triangle, and collapsing one would pinch it.
  SurfaceGeometry prism;
  for (int level = 0; level < 3; ++level) {
    for (int k = 0; k < 3; ++k) prism.positions.emplace_back(std::cos(2.0944 * k), level, std::sin(2.0944 * k));
  }
  for (int level = 0; level < 2; ++level) {
    for (int k = 0; k < 3; ++k) {
      const int a = 3 * level + k, b = 3 * level + (k + 1) % 3;
      prism.triangles.push_back({a, a + 3, b});
      prism.triangles.push_back({b, a + 3, b + 3});
    }
  }
  prism.triangles.push_back({0, 1, 2});
  prism.triangles.push_back({6, 8, 7});
  ASSERT_EQ(joined(mesh_problems(prism.positions, prism.triangles)), "");
  EditableMesh mesh(prism.positions, prism.triangles);
  EXPECT_FALSE(mesh.collapse(3, 4, kAny));
  EXPECT_FALSE(mesh.collapse(4, 5, kAny));
}

TEST(EditableMesh, SplitHalvesTheTwoTrianglesOfAnEdge) {
  Box box;
  const auto before = box.surface.triangles.size();
  const int middle = box.mesh.split(box.middle, box.beside);
  ASSERT_EQ(middle, static_cast<int>(box.surface.positions.size()) - 1);
  EXPECT_EQ(box.surface.positions[middle], Vec3(2.5, 4, 2));
  EXPECT_EQ(box.surface.triangles.size(), before + 2);
  EXPECT_EQ(joined(mesh_problems(box.surface.positions, box.surface.triangles)), "");
  EXPECT_EQ(box.mesh.split(box.middle, box.beside), -1);  // no edge any more
}

TEST(EditableMesh, FlipRefusesARidgeAndAnEdgeThatExists) {
  Box box;
  const int left = vertex_at(box.surface, {4, 4, 1}), right = vertex_at(box.surface, {4, 4, 2});
  EXPECT_FALSE(box.mesh.flip(left, right)) << "would cut the edge of the box";
  EXPECT_FALSE(box.mesh.flip(box.middle, vertex_at(box.surface, {0, 4, 0}))) << "is no edge";
}

TEST(EditableMesh, FlipRefusesATriangleTurnedOver) {
  // A kite that is not convex: the other diagonal lies outside of it.
  Box box;
  const auto ring = box.mesh.ring(box.middle);
  int refused = 0, done = 0;
  box.surface.positions[box.middle] += Vec3(0.95, 0, 0);  // almost onto `beside`
  for (int other : ring) (box.mesh.flip(box.middle, other) ? done : refused) += 1;
  EXPECT_GT(refused, 0);
  box.mesh.compact();
  for (const Triangle& triangle : box.surface.triangles) {
    if (box.surface.positions[triangle[0]].y() == 4 && box.surface.positions[triangle[1]].y() == 4 &&
        box.surface.positions[triangle[2]].y() == 4) {
      EXPECT_GT(doubled_area_vector(box.surface.positions, triangle).y(), 0);
    }
  }
}

}  // namespace
}  // namespace flowskin::tracking::editable_mesh_test
