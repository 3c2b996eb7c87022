// Walls that move: their motion itself, the fluid that they drag and push, and that nothing passes them.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "sph/walls/boundary_motion.h"
#include "sph/walls/moving_wall.h"
#include "tests/sph/test_meshes.h"

namespace flowskin::sph::moving_walls_test {
namespace {

const Vec3 zero = Vec3::Zero();

BoundaryMotion translation(const Vec3& velocity, double duration = 10) {
  BoundaryMotion motion;
  motion.keyframes = {{0, Vec3::Zero(), Vec3::Zero()}, {duration, duration * velocity, Vec3::Zero()}};
  return motion;
}

std::vector<BoundaryMotion> motions() {
  BoundaryMotion turns, tumble, smooth;
  turns.pivot = {0.3, -0.2, 1};
  turns.keyframes = {{0.5, {0, 1, 0}, {10, 20, 30}}, {2.5, {0, 1, 2}, {10, 800, 30}}, {3, zero, {10, 800, -30}}};
  tumble.pivot = {-1, 0, 0.5};
  tumble.keyframes = {{0, zero, zero}, {1, {1, 0, 0}, {100, -50, 20}}, {2, {1, 0, 0}, {100, -50, 20}}};
  smooth = tumble;
  smooth.interpolation = BoundaryMotion::Interpolation::smooth;
  return {turns, tumble, smooth, translation({1, 2, 3}, 1)};
}

TEST(BoundaryMotion, VelocityIsTheDerivativeOfThePlace) {
  for (const BoundaryMotion& motion : motions()) {
    for (double t = 0.0371; t < 3; t += 0.1) {
      constexpr double dt = 1e-6;
      const Vec3 p(0.7, 0.1, -0.4);
      const Pose pose = motion.pose(t);
      const Vec3 wanted = (motion.pose(t + dt).place(p) - motion.pose(t - dt).place(p)) / (2 * dt);
      EXPECT_LT((pose.velocity_at(pose.place(p)) - wanted).norm(), 1e-6) << t;
      EXPECT_LT((pose.to_rest(pose.place(p)) - p).norm(), 1e-14);
      EXPECT_LE(wanted.norm(), motion.greatest_speed((p - motion.pivot).norm()) + 1e-6);
    }
  }
}

TEST(BoundaryMotion, MeetsItsKeyframesAndRestsOutside) {
  const BoundaryMotion turns = motions()[0];
  const Vec3 p(1, 2, 3);
  for (const Keyframe& key : turns.keyframes) {
    const auto axis = [&](int a) { return Eigen::AngleAxisd(key.rotate[a] * M_PI / 180, Vec3::Unit(a)); };
    const Vec3 wanted = turns.pivot + key.translate + axis(2) * (axis(1) * (axis(0) * (p - turns.pivot)));
    EXPECT_LT((turns.pose(key.time).place(p) - wanted).norm(), 1e-13);
  }
  EXPECT_EQ(turns.pose(-1).place(p), turns.pose(0.5).place(p));
  EXPECT_TRUE(turns.pose(0.4).velocity_at(p).isZero(0));
  EXPECT_TRUE(turns.pose(3.1).velocity_at(p).isZero(0));
  EXPECT_EQ(turns.pose(7).place(p), turns.pose(3).place(p));
  // 780 degrees in two seconds: more than two turns, at constant speed.
  EXPECT_NEAR(turns.pose(1).angular_velocity.norm(), 780 * M_PI / 180 / 2, 1e-12);
}

TEST(MovingWall, SweepsOverNothing) {
  // A plate that turns fast: points at rest near it stay on their side of it, whatever the step.
  BoundaryMotion motion;
  motion.keyframes = {{0, zero, zero}, {1, {0.2, 0, 0}, {0, 0, 2000}}};
  const TriangleMesh plate = sheet(1, 0);
  MovingWall wall(motion, zero, plate, {}, 0, 0.1, 0.2, 0.5, {});
  Random random(3);
  struct Point {
    Vec3 place;
    double side = 0;
    bool swept_off = false;
  };
  std::vector<Point> points(50);
  for (Point& p : points) {
    p.place = Vec3(1.6, 0.2, 1.6).cwiseProduct(random.vector() - Vec3::Constant(0.5));
    p.side = p.place.y();
  }
  int held = 0;
  for (double t = 0.003; t < 0.3; t += 0.003) {
    wall.mark_build(1);
    wall.collect_triangles(0, Vec3::Constant(-1.2), Vec3::Constant(1.2), 0.1);
    wall.move_to(t);
    for (Point& p : points) {
      Vec3 target = p.place, velocity = Vec3::Zero();
      held += wall.hold(p.place, 0, target, velocity).held;
      p.place = target;
      const Vec3 rest = wall.pose().to_rest(p.place);
      p.swept_off = p.swept_off || std::max(std::abs(rest.x()), std::abs(rest.z())) > 1;
      if (!p.swept_off) {
        EXPECT_GT(rest.y() * p.side, 0);
      }
    }
  }
  EXPECT_GT(held, 100);
}

SimulationSetup tank(const Vec3& velocity) {
  SimulationSetup setup = block_setup(0.05, {0, 0, 0}, {0.3, 0.4, 0.3});
  setup.bodies[0].velocity = velocity;
  setup.settings.viscosity = 0.02;
  setup.settings.max_speed = 3;
  setup.settings.max_time_step = 3e-4;  // the acoustic limit depends on the speed of the frame
  Boundary box = tank(closed_box({0, 0, 0}, {0.5, 0.6, 0.3}), 0);
  if (!velocity.isZero(0)) box.motion = translation(velocity);
  setup.boundaries.push_back(box);
  return setup;
}

TEST(MovingWalls, UniformMotionOfEverythingChangesNothing) {
  const Vec3 velocity(0.5, -0.2, 0.3);
  constexpr double time = 0.3;
  Solver at_rest(tank(Vec3::Zero())), moving(tank(velocity));
  at_rest.advance_to(time);
  moving.advance_to(time);
  const FluidState a = at_rest.state(), b = moving.state();
  ASSERT_EQ(a.ids, b.ids);
  double worst = 0, moved = 0;
  for (std::size_t i = 0; i < a.ids.size(); ++i) {
    worst = std::max(worst, (b.positions[i] - time * velocity - a.positions[i]).norm());
    moved = std::max(moved, (a.positions[i] - a.rest_positions[i]).norm());
    EXPECT_LT((b.velocities[i] - velocity - a.velocities[i]).norm(), 1e-2);
  }
  EXPECT_GT(moved, 0.1);
  EXPECT_LT(worst, 2e-3 * 0.05);
  EXPECT_EQ(moving.statistics().wall_crossings, 0U);
}

// Fluid between two plates in a periodic box, the upper one moved by `drive`.
SimulationSetup couette(double height, const std::function<void(Boundary&)>& drive,
                        ViscositySolver viscosity_solver = ViscositySolver::explicit_steps) {
  SimulationSetup setup = block_setup(0.02, {0, 0, 0}, {0.16, height, 0.08});
  setup.settings.gravity.setZero();
  setup.settings.viscosity = 0.05;
  setup.settings.viscosity_solver = viscosity_solver;
  setup.settings.max_speed = 1;
  setup.settings.domain = {{0, 0, 0}, {0.16, 0, 0.08}};
  setup.settings.periodic = {true, false, true};
  setup.boundaries = {{sheet(0.5, 0), 0}, {sheet(0.5, height), 0}};
  drive(setup.boundaries[1]);
  return setup;
}

TEST(MovingWalls, CouetteFlowOfAConveyorAndOfAMovingPlate) {
  constexpr double height = 0.2, speed = 0.5;
  Solver belt(couette(height, [&](Boundary& b) { b.surface_velocity = {speed, 0, 0}; }));
  Solver plate(couette(height, [&](Boundary& b) { b.motion = translation({speed, 0, 0}); }));
  const double time = 6 * height * height / (M_PI * M_PI * 0.05);  // the slowest mode has fallen to 1/400
  Solver implicit(couette(
      height,
      [&](Boundary& b) {
        b.motion = translation({speed, 0, 0});
      },
      ViscositySolver::implicit));
  for (Solver* solver : {&belt, &plate, &implicit}) {
    solver->advance_to(time);
    const FluidState state = solver->state();
    double square = 0;
    for (std::size_t i = 0; i < state.ids.size(); ++i) {
      const double error = state.velocities[i].x() - speed * state.positions[i].y() / height;
      square += error * error / static_cast<double>(state.ids.size());
    }
    EXPECT_LT(std::sqrt(square), 0.03 * speed);
    EXPECT_EQ(solver->statistics().wall_crossings, 0U);
  }
}

TEST(MovingWalls, TurningBoxTakesItsFluidAlong) {
  SimulationSetup setup = block_setup(0.025, {-0.125, -0.125, -0.125}, {0.125, 0.125, 0.125});
  setup.settings.gravity.setZero();
  setup.settings.viscosity = 0.05;
  Boundary box = tank(closed_box({-0.125, -0.125, -0.125}, {0.125, 0.125, 0.125}), 0);
  box.motion.keyframes = {{0, zero, zero}, {10, zero, {0, 3600, 0}}};
  setup.boundaries.push_back(box);
  Solver solver(setup);
  solver.advance_to(0.5);  // h^2 / (pi^2 nu) is 0.03 s
  const FluidState state = solver.state();
  double spin = 0, rigid = 0;
  int outside = 0;
  const Vec3 axis(0, 2 * M_PI, 0);
  const Pose pose = box.motion.pose(0.5);
  for (std::size_t i = 0; i < state.ids.size(); ++i) {
    spin += state.positions[i].cross(state.velocities[i]).y();
    rigid += state.positions[i].cross(axis.cross(state.positions[i])).y();
    outside += pose.to_rest(state.positions[i]).cwiseAbs().maxCoeff() >= 0.125;
  }
  EXPECT_NEAR(spin / rigid, 1, 0.03);
  EXPECT_EQ(outside, 0);
  EXPECT_EQ(solver.statistics().squeezed_through, 0U);
}

// The four long sides of a tube along x.
TriangleMesh tube(double length, double half) {
  TriangleMesh mesh = closed_box({-0.2, -half, -half}, {length, half, half});
  std::erase_if(mesh.triangles, [&](const auto& t) {
    const double x = mesh.positions[t[0]].x();
    return mesh.positions[t[1]].x() == x && mesh.positions[t[2]].x() == x;
  });
  return mesh;
}

TriangleMesh upright_sheet(double x, double half) {
  TriangleMesh mesh;
  add_quad(mesh, {x, -half, -half}, {x, half, -half}, {x, half, half}, {x, -half, half});
  return mesh;
}

TEST(MovingWalls, PistonLosesNothing) {
  for (const double speed : {0.5, 3.0}) {
    SimulationSetup setup = block_setup(0.03, {0, -0.12, -0.12}, {0.24, 0.12, 0.12});
    setup.settings.gravity.setZero();
    setup.settings.viscosity = 0.002;
    setup.boundaries = {tank(tube(3, 0.12), 0), {upright_sheet(-0.02, 0.12), 0}};
    setup.boundaries[1].motion = translation({speed, 0, 0});
    Solver solver(setup);
    EXPECT_GE(solver.settings().max_speed, speed);
    solver.advance_to(0.6 / speed);
    const FluidState state = solver.state();
    for (const Vec3& p : state.positions) {
      EXPECT_GT(p.x(), -0.02 + 0.6) << speed;
      EXPECT_LT(std::max(std::abs(p.y()), std::abs(p.z())), 0.12) << speed;
    }
    EXPECT_EQ(solver.statistics().squeezed_through, 0U) << speed;
  }
}

// Whether the path from a to b passes the square |y|, |z| < half of the plane x = 0; written apart from the guard.
bool passes(const Vec3& a, const Vec3& b, double half) {
  if ((a.x() > 0) == (b.x() > 0)) return false;
  const Vec3 p = a + a.x() / (a.x() - b.x()) * (b - a);
  return std::max(std::abs(p.y()), std::abs(p.z())) < half;
}

TEST(MovingWalls, PaddleIsNeverCrossed) {
  // A paddle, smaller than the box, turns in thin fluid. Paths are looked at in its own frame.
  constexpr double half = 0.09;
  SimulationSetup setup = block_setup(0.03, {-0.15, -0.15, -0.15}, {0.15, 0.09, 0.15});
  setup.settings.viscosity = 0.001;
  setup.boundaries = {tank(closed_box({-0.15, -0.15, -0.15}, {0.15, 0.3, 0.15}), 0), {upright_sheet(0, half), 0}};
  BoundaryMotion& motion = setup.boundaries[1].motion;
  motion.keyframes = {{0, zero, zero}, {1, zero, {0, 720, 0}}};
  Solver solver(setup);
  FluidState before = solver.state();
  int crossed = 0;
  while (solver.time() < 0.2) {
    const Pose from = motion.pose(solver.time());
    solver.step();
    const Pose to = motion.pose(solver.time());
    const FluidState after = solver.state();
    ASSERT_EQ(before.ids, after.ids);
    for (std::size_t i = 0; i < after.ids.size(); ++i) {
      crossed += passes(from.to_rest(before.positions[i]), to.to_rest(after.positions[i]), half);
    }
    before = after;
  }
  EXPECT_EQ(crossed, 0);
  EXPECT_EQ(solver.statistics().squeezed_through, 0U);
  EXPECT_GT(solver.energy().kinetic, 0.01);
  for (const Vec3& p : before.positions) EXPECT_LT(std::max(std::abs(p.x()), std::abs(p.z())), 0.15);
}

TEST(MovingWalls, WallsThatCloseInKeepTheContainerTight) {
  // A plate pressed into the closed end of a tube: there is no room, and the fluid must pass the plate, not the tube.
  SimulationSetup setup = block_setup(0.03, {0, -0.06, -0.06}, {0.06, 0.06, 0.06});
  setup.settings.gravity.setZero();
  TriangleMesh can = tube(0.06, 0.06);
  add_quad(can, {0.06, -0.06, -0.06}, {0.06, 0.06, -0.06}, {0.06, 0.06, 0.06}, {0.06, -0.06, 0.06});
  setup.boundaries = {tank(can, 0), {upright_sheet(-0.005, 0.06), 0}};
  setup.boundaries[1].motion = translation({0.5, 0, 0}, 0.12);
  Solver solver(setup);
  try {
    solver.advance_to(0.12);
  } catch (const BlowUpError&) {
    // As it may: the message says that the space is too small.
  }
  for (const Vec3& p : solver.state().positions) {
    EXPECT_LT(p.x(), 0.06);
    EXPECT_LT(std::max(std::abs(p.y()), std::abs(p.z())), 0.06);
  }
}

TEST(MovingWalls, ImpossibleMotionIsExplained) {
  SimulationSetup setup = tank(Vec3::UnitX());
  setup.boundaries[0].motion.keyframes[1].time = 0;
  try {
    const Solver solver(setup);
    FAIL();
  } catch (const SettingsError& error) {
    EXPECT_NE(std::string(error.what()).find("boundary 1: keyframe 2 at 0 s must be later"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace flowskin::sph::moving_walls_test
