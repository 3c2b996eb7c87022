// Filling of bodies, and emitters.
#include "sph/bodies/fluid_bodies.h"

#include <gtest/gtest.h>

#include "sph/bodies/jet_emitter.h"
#include "sph/geometry/mesh_inside.h"
#include "tests/sph/test_meshes.h"

namespace flowskin::sph::fluid_bodies_test {
namespace {

FluidBody block(const Vec3& min, const Vec3& max) {
  FluidBody body;
  body.block = {min, max};
  return body;
}

FluidBody mesh_body(const TriangleMesh& mesh) {
  FluidBody body;
  body.shape = FluidBody::Shape::mesh;
  body.mesh = mesh;
  return body;
}

TEST(FluidBodies, BlockOfNSpacingsHasNParticles) {
  for (const double spacing : {0.1, 0.03, 1.0 / 7}) {
    const auto points = fill_bodies({block({1, 2, 3}, Vec3(1, 2, 3) + spacing * Vec3(5, 4, 3))}, spacing, {});
    ASSERT_EQ(points.size(), 60U);
    EXPECT_NEAR((points[0].position - (Vec3(1, 2, 3) + Vec3::Constant(0.5 * spacing))).norm(), 0, 1e-12);
  }
}

TEST(FluidBodies, VolumeOfABall) {
  FluidBody ball;
  ball.shape = FluidBody::Shape::ball;
  ball.center = {0.1, 0.2, 0.3};
  ball.radius = 0.5;
  const auto points = fill_bodies({ball}, 0.05, {});
  const double volume = 4.0 / 3 * M_PI * 0.125;
  EXPECT_NEAR(static_cast<double>(points.size()) * 0.000125, volume, 0.03 * volume);
}

TEST(FluidBodies, CutsStayEmpty) {
  // 8 x 8 x 8 particles less a slot 2 wide and 5 deep, and a corner that the slot does not touch.
  FluidBody body = block({0, 0, 0}, {0.8, 0.8, 0.8});
  body.cuts = {{{0.3, -1, -1}, {0.5, 0.5, 2}}, {{0.7, 0.7, 0.7}, {1, 1, 1}}};
  const auto points = fill_bodies({body}, 0.1, {});
  EXPECT_EQ(points.size(), 512U - 2 * 5 * 8 - 1);
  for (const FluidPoint& p : points) EXPECT_FALSE(std::abs(p.position.x() - 0.4) < 0.1 && p.position.y() < 0.5);
  body.cuts = {{{-1, -1, -1}, {1, 1, 1}}};
  EXPECT_THROW(fill_bodies({body}, 0.1, {}), SettingsError);
}

TEST(FluidBodies, MeshIsFilledWhereTheShapeIs) {
  const Vec3 center(0.3, -1, 2);
  const TriangleMesh mesh = sphere(center, 0.5, 60);
  Vec3 low = Vec3::Constant(1e30), high = -low;
  for (const Vec3& p : mesh.positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const double spacing = 0.04, chord_error = 0.002;
  const auto points = fill_bodies({mesh_body(mesh)}, spacing, {});
  std::size_t wanted_least = 0, wanted_most = 0;
  for (int i = 0; low.x() + i * spacing < high.x(); ++i) {
    for (int j = 0; low.y() + j * spacing < high.y(); ++j) {
      for (int k = 0; low.z() + k * spacing < high.z(); ++k) {
        const double r = (low + spacing * Vec3(i + 0.5, j + 0.5, k + 0.5) - center).norm();
        wanted_least += r < 0.5 - chord_error;
        wanted_most += r < 0.5;
      }
    }
  }
  for (const FluidPoint& p : points) EXPECT_LT((p.position - center).norm(), 0.5);
  EXPECT_GE(points.size(), wanted_least);
  EXPECT_LE(points.size(), wanted_most);
}

TEST(FluidBodies, RowsThroughEdgesAndCornersAreCountedOnce) {
  // The diagonals of the box's faces pass exactly through the rows of this lattice.
  const auto points = fill_bodies({mesh_body(closed_box({0, 0, 0}, {1, 1, 1}))}, 0.125, {});
  EXPECT_EQ(points.size(), 512U);
}

TEST(FluidBodies, HollowStaysEmpty) {
  TriangleMesh shell = closed_box({0, 0, 0}, {1, 1, 1});
  TriangleMesh hollow = closed_box({0.25, 0.25, 0.25}, {0.75, 0.75, 0.75});
  const int first = static_cast<int>(shell.positions.size());
  shell.positions.insert(shell.positions.end(), hollow.positions.begin(), hollow.positions.end());
  for (const auto& t : hollow.triangles) shell.triangles.push_back({first + t[0], first + t[2], first + t[1]});
  EXPECT_EQ(fill_bodies({mesh_body(shell)}, 0.125, {}).size(), 512U - 64U);
}

TEST(FluidBodies, OverlapsAreFilledOnce) {
  const FluidBody a = block({0, 0, 0}, {1, 1, 1}), b = block({0.5, 0, 0}, {1.5, 1, 1});
  EXPECT_EQ(fill_bodies({a, b}, 0.1, {}).size(), 1500U);
  const auto points = fill_bodies({a, block({0.53, 0, 0}, {1.53, 1, 1})}, 0.1, {});
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_GE((points[i].position - points[j].position).norm(), 0.0699);
  }
}

TEST(FluidBodies, KeepsAwayFromWalls) {
  EXPECT_EQ(fill_bodies({block({0, 0, 0}, {0.5, 0.5, 0.5})}, 0.1, {Vec3(0.25, 0.25, 0.25)}).size(), 124U);
  // A lattice that stands on a wall keeps its first layer.
  EXPECT_EQ(fill_bodies({block({0, 0, 0}, {0.5, 0.5, 0.5})}, 0.1, {Vec3(0.25, 0, 0.25)}).size(), 125U);
}

TEST(FluidBodies, SpinIsAboutTheCentroid) {
  FluidBody body = block({1, 1, 1}, {2, 2, 2});
  body.velocity = {3, 0, 0};
  body.angular_velocity = {0, 2, 0};
  Vec3 momentum = Vec3::Zero();
  const auto points = fill_bodies({body}, 0.1, {});
  for (const FluidPoint& p : points) {
    momentum += p.velocity;
    EXPECT_NEAR((p.velocity - Vec3(3, 0, 0) - Vec3(0, 2, 0).cross(p.position - Vec3::Constant(1.5))).norm(), 0, 1e-12);
  }
  EXPECT_NEAR((momentum / static_cast<double>(points.size()) - Vec3(3, 0, 0)).norm(), 0, 1e-12);
}

TEST(FluidBodies, ImpossibleBodiesAreErrors) {
  EXPECT_THROW(fill_bodies({block({0, 0, 0}, {0.01, 1, 1})}, 0.1, {}), SettingsError);  // no particle
  EXPECT_THROW(fill_bodies({block({0, 0, 0}, {-1, 1, 1})}, 0.1, {}), SettingsError);
  FluidBody ball;
  ball.shape = FluidBody::Shape::ball;
  EXPECT_THROW(fill_bodies({ball}, 0.1, {}), SettingsError);
  TriangleMesh open = closed_box({0, 0, 0}, {1, 1, 1});
  open.triangles.pop_back();
  EXPECT_FALSE(is_closed(open));
  EXPECT_THROW(fill_bodies({mesh_body(open)}, 0.1, {}), SettingsError);
  EXPECT_THROW(fill_bodies({mesh_body({})}, 0.1, {}), SettingsError);
  const FluidBody a = block({0, 0, 0}, {1, 1, 1});
  EXPECT_THROW(fill_bodies({a, a}, 0.1, {}), SettingsError);  // the second has no particle left
}

Emitter make_emitter() {
  Emitter emitter;
  emitter.center = {0, 1, 0};
  emitter.direction = {0, -2, 0};
  emitter.radius = 0.2;
  emitter.speed = 0.5;
  emitter.start = 0.1;
  emitter.stop = 2;
  return emitter;
}

TEST(JetEmitter, FlowRateIsAreaTimesSpeed) {
  const double spacing = 0.025;
  JetEmitter jet(make_emitter(), spacing, "emitter");
  std::vector<JetEmitter::Particle> particles;
  EXPECT_EQ(jet.pour(5, {}, particles), 0U);
  const double volume = static_cast<double>(particles.size()) * std::pow(spacing, 3);
  // Exact but for the last layer, of about 38.
  EXPECT_NEAR(volume, M_PI * 0.04 * 0.5 * 1.9, 0.02 * volume);
  EXPECT_EQ(particles.size() % jet.layer_size(), 0U);
}

TEST(JetEmitter, PlacesDoNotDependOnTheSteps) {
  JetEmitter coarse(make_emitter(), 0.05, "emitter"), fine(make_emitter(), 0.05, "emitter");
  std::vector<JetEmitter::Particle> a, b, poured;
  const double end = 0.97;
  coarse.pour(end, {}, a);
  for (int k = 0; k <= 80; ++k) {
    const double t = end * k / 80;
    poured.clear();
    fine.pour(t, {}, poured);
    for (auto& p : poured) {
      p.position += (end - t) * fine.velocity();  // on their way until the end
      b.push_back(p);
    }
  }
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_NEAR((a[i].position - b[i].position).norm(), 0, 1e-9);
    EXPECT_NEAR((a[i].rest_position - b[i].rest_position).norm(), 0, 1e-12);
    // The jet continued backwards: the place at the end less the way since time 0.
    EXPECT_NEAR((a[i].position - end * coarse.velocity() - a[i].rest_position).norm(), 0, 1e-12);
  }
}

TEST(JetEmitter, ImpossibleEmittersAreErrors) {
  Emitter emitter = make_emitter();
  emitter.radius = 0;
  EXPECT_THROW(JetEmitter(emitter, 0.1, "emitter"), SettingsError);
  emitter = make_emitter();
  emitter.speed = -1;
  EXPECT_THROW(JetEmitter(emitter, 0.1, "emitter"), SettingsError);
  emitter = make_emitter();
  emitter.direction.setZero();
  EXPECT_THROW(JetEmitter(emitter, 0.1, "emitter"), SettingsError);
  emitter = make_emitter();
  emitter.stop = 0;
  EXPECT_THROW(JetEmitter(emitter, 0.1, "emitter"), SettingsError);
}

}  // namespace
}  // namespace flowskin::sph::fluid_bodies_test
