// Emitters of any shape, and sinks, in the running solver.
#include <gtest/gtest.h>

#include "sph/bodies/jet_emitter.h"
#include "sph/geometry/mesh_inside.h"
#include "tests/sph/test_meshes.h"

namespace flowskin::sph::emitters_test {
namespace {

Emitter rectangle(double width, double height) {
  Emitter emitter;
  emitter.shape = Emitter::Shape::rectangle;
  emitter.center = {0, 1, 0};
  emitter.width = width;
  emitter.height = height;
  emitter.speed = 1;
  return emitter;
}

// An L of two quads in the plane y = 0, area 3 * 0.1^2.
TriangleMesh l_shape() {
  TriangleMesh mesh;
  add_quad(mesh, {0, 0, 0}, {0.2, 0, 0}, {0.2, 0, 0.1}, {0, 0, 0.1});
  add_quad(mesh, {0, 0, 0.1}, {0.1, 0, 0.1}, {0.1, 0, 0.2}, {0, 0, 0.2});
  return mesh;
}

Emitter mesh_emitter(const TriangleMesh& mesh) {
  Emitter emitter;
  emitter.shape = Emitter::Shape::mesh;
  emitter.mesh = mesh;
  emitter.speed = 1;
  return emitter;
}

TEST(EmitterOutlet, AreasAndParticlesOfEachShape) {
  const double spacing = 0.013;
  Emitter disc;
  disc.radius = 0.1;
  const double round = M_PI * 0.01;
  const std::pair<Emitter, double> cases[] = {{disc, round},
                                              {rectangle(0.2, 0.07), 0.014},
                                              {mesh_emitter(l_shape()), 0.03},
                                              {mesh_emitter(sphere({0, 0, 0}, 0.1, 30)), round},
                                              {mesh_emitter(closed_box({0, 0, 0}, {0.2, 0.4, 0.07})), 0.014}};
  for (const auto& [emitter, area] : cases) {
    const EmitterOutlet outlet(emitter, spacing, "emitter");
    EXPECT_NEAR(outlet.area(), area, 0.015 * area);
    const double count = static_cast<double>(outlet.offsets().size());
    // Whole particles: up to 16 by 6 of them for the 15.4 by 5.4 that fit into the smallest one.
    EXPECT_NEAR(count * spacing * spacing, area, 0.16 * area);
    for (const Vec3& offset : outlet.offsets()) {
      EXPECT_NEAR(offset.dot(outlet.axis()), 0, 1e-12);
      EXPECT_TRUE(outlet.contains(outlet.center() + offset, 0.3 * spacing));
    }
  }
}

TEST(EmitterOutlet, RectangleLiesAlongUp) {
  Emitter emitter = rectangle(0.3, 0.1);
  emitter.direction = {1, 0, 0};
  EmitterOutlet outlet(emitter, 0.02, "emitter");  // height along y, width along z
  EXPECT_TRUE(outlet.contains({0, 1.04, 0.14}, 0));
  EXPECT_FALSE(outlet.contains({0, 1.06, 0}, 0));
  emitter.up = {0, 0, 1};
  outlet = EmitterOutlet(emitter, 0.02, "emitter");
  EXPECT_TRUE(outlet.contains({0, 1.14, 0.04}, 0));
  EXPECT_FALSE(outlet.contains({0, 1, 0.06}, 0));
}

TEST(EmitterOutlet, ShadowHasHolesAndStartsForemost) {
  const EmitterOutlet outlet(mesh_emitter(l_shape()), 0.01, "emitter");
  EXPECT_TRUE(outlet.contains({0.15, 0, 0.05}, 0));
  EXPECT_FALSE(outlet.contains({0.15, 0, 0.15}, 0.01));
  EXPECT_TRUE(outlet.contains({0.15, 0, 0.105}, 0.01));
  const EmitterOutlet solid(mesh_emitter(closed_box({0, 0, 0}, {0.2, 0.4, 0.07})), 0.01, "emitter");
  EXPECT_NEAR(solid.center().y(), 0, 1e-12);  // pours downwards
}

TEST(EmitterOutlet, ImpossibleShapesAreErrors) {
  EXPECT_THROW(EmitterOutlet(rectangle(0, 1), 0.1, "emitter"), SettingsError);
  EXPECT_THROW(EmitterOutlet(mesh_emitter({}), 0.1, "emitter"), SettingsError);
  Emitter emitter = rectangle(1, 1);
  emitter.up = emitter.direction;
  EXPECT_THROW(EmitterOutlet(emitter, 0.1, "emitter"), SettingsError);
  TriangleMesh edge_on;
  add_quad(edge_on, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});  // seen from above a line
  EXPECT_THROW(EmitterOutlet(mesh_emitter(edge_on), 0.1, "emitter"), SettingsError);
}

TEST(Emitters, PourAreaTimesSpeedTimesTimeWithoutClumps) {
  const double spacing = 0.02;
  for (const Emitter& emitter : {rectangle(0.13, 0.07), mesh_emitter(l_shape())}) {
    SimulationSetup setup;
    setup.settings.spacing = spacing;
    setup.settings.max_speed = 5;
    setup.emitters.push_back(emitter);
    Solver solver(setup);
    const double area = EmitterOutlet(emitter, spacing, "emitter").area(), end = 1.2;
    solver.advance_to(end);
    const double volume = static_cast<double>(solver.particle_count()) * spacing * spacing * spacing;
    EXPECT_NEAR(volume, area * emitter.speed * end, 0.02 * volume);
    EXPECT_EQ(solver.statistics().not_emitted, 0U);
    const FluidState state = solver.state();
    double nearest = 1, densest = 0;
    for (std::size_t i = 0; i < state.positions.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) nearest = std::min(nearest, (state.positions[i] - state.positions[j]).norm());
      densest = std::max(densest, state.densities[i]);
    }
    EXPECT_GT(nearest, 0.7 * spacing);
    EXPECT_LT(densest, 1010);
  }
}

TEST(Emitters, StopAtTheirMostParticles) {
  SimulationSetup setup;
  setup.settings.spacing = 0.05;
  setup.emitters.push_back(rectangle(0.2, 0.2));  // 16 per layer
  setup.emitters[0].max_particles = 100;
  setup.settings.gravity = Vec3::Zero();
  Solver solver(setup);
  solver.advance_to(1);
  EXPECT_EQ(solver.particle_count(), 96U);
}

// A closed box is poured full: the emitter closes by itself, and opens again as a sink makes room.
TEST(Emitters, BlockedOutletCloses) {
  SimulationSetup setup;
  setup.settings.spacing = 0.05;
  setup.settings.max_speed = 3;
  setup.settings.viscosity = 0.01;  // else the jet's energy stays in the box, which boils
  setup.boundaries.push_back(tank(closed_box({-0.2, 0, -0.2}, {0.2, 0.4, 0.2}), 0));
  setup.emitters.push_back(rectangle(0.2, 0.2));
  setup.emitters[0].center = {0, 0.35, 0};
  Sink sink;
  sink.box = {{-0.2, 0, -0.2}, {0.2, 0.1, 0.2}};
  sink.start = 2.5;
  sink.stop = 2.6;
  setup.sinks.push_back(sink);
  Solver solver(setup);
  solver.advance_to(2);
  const std::size_t full = solver.particle_count();
  EXPECT_GT(full, 400U);  // 512 fill the box
  EXPECT_LT(full, 620U);
  solver.advance_to(2.4);
  EXPECT_NEAR(static_cast<double>(solver.particle_count()), static_cast<double>(full), 16);
  const std::uint64_t before = solver.statistics().emitted;
  solver.advance_to(4);
  EXPECT_GT(solver.statistics().drained, 50U);
  EXPECT_GT(solver.statistics().emitted, before + 32);
}

TEST(Sinks, RemoveAndCountWhileTheyAreOpen) {
  for (const auto shape : {Sink::Shape::box, Sink::Shape::ball, Sink::Shape::mesh}) {
    SimulationSetup setup = block_setup(0.1, {0, 0, 0}, {1, 1, 1});
    setup.settings.gravity.setZero();
    Sink sink;
    sink.shape = shape;
    sink.box = {{0, 0, 0}, {0.5, 1, 1}};
    sink.center = {0, 0, 0};
    sink.radius = 0.5;
    sink.mesh = closed_box({0, 0, 0}, {0.5, 1, 1});
    sink.start = 0.1;
    sink.stop = 0.2;
    setup.sinks.push_back(sink);
    std::size_t inside = 500;
    if (shape == Sink::Shape::ball) {
      inside = 0;
      for (const Vec3& p : Solver(setup).state().positions) inside += p.norm() <= 0.5;
    }
    Solver solver(setup);
    solver.advance_to(0.09);
    EXPECT_EQ(solver.particle_count(), 1000U);
    solver.advance_to(0.15);
    EXPECT_EQ(solver.particle_count(), 1000U - inside);
    EXPECT_EQ(solver.statistics().drained, inside);
  }
}

TEST(Sinks, PointsInsideMeshes) {
  const TriangleMesh ball = sphere({0.1, 0.2, 0.3}, 0.5, 20);
  Random random(7);
  for (int k = 0; k < 2000; ++k) {
    const Vec3 p = 1.4 * (random.vector() - Vec3::Constant(0.5)) + Vec3(0.1, 0.2, 0.3);
    const double r = (p - Vec3(0.1, 0.2, 0.3)).norm();
    if (r > 0.49 && r < 0.5) continue;
    EXPECT_EQ(is_inside(ball, p), r < 0.49);
    EXPECT_EQ(InsideTest(ball)(p), r < 0.49);
  }
}

TEST(Sinks, ImpossibleSinksAreErrors) {
  SimulationSetup setup = block_setup(0.1, {0, 0, 0}, {1, 1, 1});
  setup.sinks.emplace_back();
  EXPECT_THROW(Solver{setup}, SettingsError);  // an empty box
  setup.sinks[0].shape = Sink::Shape::ball;
  EXPECT_THROW(Solver{setup}, SettingsError);
  setup.sinks[0].shape = Sink::Shape::mesh;
  setup.sinks[0].mesh = sheet(1, 0);
  EXPECT_THROW(Solver{setup}, SettingsError);  // not closed
  setup.sinks[0].mesh = closed_box({0, 0, 0}, {1, 1, 1});
  setup.sinks[0].stop = 0;
  EXPECT_THROW(Solver{setup}, SettingsError);
}

// A tank that is filled steadily and overflows into a sink comes to a steady level, at the sink's edge.
TEST(Sinks, TankWithInflowAndOutflowComesToASteadyLevel) {
  const double spacing = 0.05;
  SimulationSetup setup;
  setup.settings.spacing = spacing;
  setup.settings.viscosity = 0.002;
  setup.settings.max_speed = 3;
  setup.boundaries.push_back(tank(closed_box({0, 0, 0}, {0.6, 1, 0.4}), 0));
  Emitter emitter = rectangle(0.1, 0.2);
  emitter.center = {0.1, 0.7, 0.2};
  emitter.speed = 0.8;
  setup.emitters.push_back(emitter);
  Sink sink;
  sink.box = {{0.45, 0.4, 0}, {0.6, 1, 0.4}};
  setup.sinks.push_back(sink);
  Solver solver(setup);
  solver.advance_to(7);
  const auto emitted = solver.statistics().emitted, drained = solver.statistics().drained;
  const std::size_t count = solver.particle_count();
  solver.advance_to(10);
  const auto in = static_cast<double>(solver.statistics().emitted - emitted);
  EXPECT_NEAR(in, 0.02 * 0.8 * 3 / (spacing * spacing * spacing), 0.05 * in);
  EXPECT_NEAR(static_cast<double>(solver.statistics().drained - drained), in, 0.1 * in);
  EXPECT_NEAR(static_cast<double>(solver.particle_count()), static_cast<double>(count),
              0.04 * static_cast<double>(count));
  // Fluid below the edge fills the tank.
  const double level = static_cast<double>(count) * spacing * spacing * spacing / (0.6 * 0.4);
  EXPECT_NEAR(level, 0.4, 0.06);
}

}  // namespace
}  // namespace flowskin::sph::emitters_test
