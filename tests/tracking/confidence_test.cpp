// How well the field determines the tangential velocity, on bodies whose symmetries are known.
#include "tracking/velocity/confidence.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "tests/tracking/field_test_bodies.h"
#include "tracking/advection/projection.h"
#include "tracking/field/metaballs/metaball_field.h"

namespace flowskin::tracking::confidence_test {
namespace {

std::vector<Vec3> points_on(const MetaballField& field, const std::vector<Vec3>& starts) {
  std::vector<Vec3> points = starts;
  const Projection projection = project_to_surface(field, default_projection(field.scale()), points);
  EXPECT_TRUE(projection.failed.empty());
  return points;
}

TEST(Confidence, ABallHasNone) {
  const MetaballField field({Vec3(0.1, 0.2, 0.3)}, {}, {1, 0.2, 1});
  for (const Confidence& confidence :
       field_confidence(field, points_on(field, {{0.6, 0.2, 0.3}, {0.1, 0.2, -0.3}, {0.4, 0.5, 0.6}}))) {
    EXPECT_LT(confidence.weak, 1e-6);
    EXPECT_LT(confidence.strong, 1e-6);
  }
}

TEST(Confidence, ABodyOfRevolutionHidesItsSpin) {
  const MetaballField field({{-0.35, 0, 0}, {0.35, 0, 0}}, {}, {1, 0.6, 1});
  const std::vector<Vec3> points = points_on(field, {{0.15, 0.4, 0.1}, {-0.2, 0.3, -0.3}});
  const std::vector<Confidence> found = field_confidence(field, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_LT(found[i].weak, 1e-6);
    EXPECT_GT(found[i].strong, 0.05);
    const Vec3 around = Vec3::UnitX().cross(points[i]).normalized();
    EXPECT_GT(std::abs(found[i].weak_direction.dot(around)), 0.999);
  }
}

TEST(Confidence, IsTheSameAtAllSizesAndInAllDirections) {
  const std::vector<Vec3> particles = test::lattice(0.4, 2, 0.3, 73, [](const Vec3& x) { return x.norm() < 0.9; });
  const MetaballField field(particles, {}, {1, 0.5, 1});
  const std::vector<Vec3> points = points_on(field, {{1.2, 0, 0}, {0, 1.2, 0.1}, {0.3, -0.4, 1.1}});
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, -1, 2).normalized()).toRotationMatrix();
  const auto moved = [&](const Vec3& x) { return Vec3(1000 * (turn * x) + Vec3(3, 4, 5)); };
  const MetaballField other(test::velocities_of(particles, moved), {}, {1000, 1.0, 2});
  const auto here = field_confidence(field, points);
  const auto there = field_confidence(other, test::velocities_of(points, moved));
  for (std::size_t i = 0; i < here.size(); ++i) {
    EXPECT_GT(here[i].weak, 1e-4);
    EXPECT_LE(here[i].strong, 1);
    EXPECT_NEAR(here[i].weak, there[i].weak, 1e-8);
    EXPECT_NEAR(here[i].strong, there[i].strong, 1e-8);
    EXPECT_GT(std::abs((turn * here[i].weak_direction).dot(there[i].weak_direction)), 1 - 1e-6);
  }
}

TEST(Confidence, IsZeroWhereTheFieldIsSilent) {
  const MetaballField field({Vec3::Zero()}, {}, {1, 0.5, 1});
  const auto found = field_confidence(field, {Vec3(5, 0, 0), Vec3::Zero(), Vec3::Constant(std::nan(""))});
  for (const Confidence& confidence : found) {
    EXPECT_EQ(confidence.weak, 0);
    EXPECT_EQ(confidence.strong, 0);
  }
}

}  // namespace
}  // namespace flowskin::tracking::confidence_test
