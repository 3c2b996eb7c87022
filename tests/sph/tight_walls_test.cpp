// Fluid shot at thin walls, edges, corners and gaps, at rest and moving: every path of every particle is tested against
// the triangles, by an intersection test that is not the solver's own, and nothing passes.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/sph/test_meshes.h"

namespace flowskin::sph::tight_walls_test {
namespace {

constexpr double spacing = 0.03;

// Whether the segment from a to b passes the triangle p, q, r [Moller and Trumbore 1997].
bool passes(const Vec3& a, const Vec3& b, const Vec3& p, const Vec3& q, const Vec3& r) {
  const Vec3 way = b - a, e1 = q - p, e2 = r - p, h = way.cross(e2);
  const double determinant = e1.dot(h);
  if (determinant == 0) return false;
  const Vec3 s = a - p, k = s.cross(e1);
  const double u = s.dot(h) / determinant, v = way.dot(k) / determinant, t = e2.dot(k) / determinant;
  return u >= 0 && v >= 0 && u + v <= 1 && t >= 0 && t <= 1;
}

// A mesh with its bounding box: most paths do not come near.
struct Obstacle {
  explicit Obstacle(const TriangleMesh& triangles) : mesh(triangles) {
    for (const Vec3& p : mesh.positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
  }
  int paths_through(const Vec3& a, const Vec3& b) const {
    if ((a.cwiseMax(b) - low).minCoeff() < 0 || (high - a.cwiseMin(b)).minCoeff() < 0) return 0;
    int count = 0;
    const auto& x = mesh.positions;
    for (const auto& t : mesh.triangles) count += passes(a, b, x[t[0]], x[t[1]], x[t[2]]);
    return count;
  }
  TriangleMesh mesh;
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
};

struct Outcome {
  int passed = 0;               // paths through a triangle of a wall
  int through_mouth = 0;        // paths through the mouth of a gap
  double greatest_density = 0;  // in rest densities
  FluidState end;
  SolverStatistics statistics;
};

// Paths are looked at in the frame of each wall. The mouth moves with the last wall.
Outcome shoot(const SimulationSetup& setup, double time, const TriangleMesh& mouth = {}) {
  Solver solver(setup);
  Outcome outcome;
  const Obstacle gap(mouth);
  std::vector<Obstacle> walls;
  for (const Boundary& boundary : setup.boundaries) walls.emplace_back(boundary.mesh);
  FluidState before = solver.state();
  while (solver.time() < time) {
    const double from = solver.time();
    solver.step();
    const FluidState after = solver.state();
    for (std::size_t w = 0; w < walls.size(); ++w) {
      const BoundaryMotion& motion = setup.boundaries[w].motion;
      const Pose old_pose = motion.pose(from), pose = motion.pose(solver.time());
      for (std::size_t i = 0; i < after.ids.size(); ++i) {
        const Vec3 a = old_pose.to_rest(before.positions[i]), b = pose.to_rest(after.positions[i]);
        outcome.passed += walls[w].paths_through(a, b);
        if (w + 1 == walls.size()) outcome.through_mouth += gap.paths_through(a, b);
      }
    }
    for (const double density : after.densities) {
      outcome.greatest_density = std::max(outcome.greatest_density, density / 1000);
    }
    before = after;
  }
  outcome.end = before;
  outcome.statistics = solver.statistics();
  return outcome;
}

FluidBody block(const Vec3& min, const Vec3& max, const Vec3& velocity) {
  FluidBody body;
  body.block = {min, max};
  body.velocity = velocity;
  return body;
}

SimulationSetup shot(const TriangleMesh& wall, const std::vector<FluidBody>& bodies) {
  SimulationSetup setup;
  setup.settings.spacing = spacing;
  setup.settings.gravity.setZero();
  setup.settings.viscosity = 0.0005;
  setup.bodies = bodies;
  setup.boundaries.push_back(tank(wall, 0));
  return setup;
}

// Two plates that meet in an edge along z at the origin and open downwards (or upwards) by the angle in degrees.
TriangleMesh wedge(double angle, double down) {
  const double a = angle * M_PI / 360, x = 0.6 * std::sin(a), y = -0.6 * std::cos(a) * down;
  TriangleMesh mesh;
  add_quad(mesh, {0, 0, -0.4}, {-x, y, -0.4}, {-x, y, 0.4}, {0, 0, 0.4});
  add_quad(mesh, {0, 0, -0.4}, {0, 0, 0.4}, {x, y, 0.4}, {x, y, -0.4});
  return mesh;
}

// A spike with three faces, its tip at the origin.
TriangleMesh spike() {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {0.05, -0.5, 0}, {-0.03, -0.5, 0.05}, {-0.03, -0.5, -0.05}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}};
  return mesh;
}

// A floor with a slot along z, and what fills the slot.
TriangleMesh slotted_floor(double width) {
  TriangleMesh mesh;
  const double s = width / 2;
  add_quad(mesh, {-0.4, 0, -0.4}, {-0.4, 0, 0.4}, {-s, 0, 0.4}, {-s, 0, -0.4});
  add_quad(mesh, {s, 0, -0.4}, {s, 0, 0.4}, {0.4, 0, 0.4}, {0.4, 0, -0.4});
  return mesh;
}
TriangleMesh slot(double width) {
  TriangleMesh mesh;
  const double s = width / 2;
  add_quad(mesh, {-s, 0, -0.4}, {-s, 0, 0.4}, {s, 0, 0.4}, {s, 0, -0.4});
  return mesh;
}

// The same of two blocks with thickness.
TriangleMesh two_blocks(double width) {
  TriangleMesh mesh = closed_box({-0.4, -0.2, -0.4}, {-width / 2, 0, 0.4});
  const TriangleMesh other = closed_box({width / 2, -0.2, -0.4}, {0.4, 0, 0.4});
  for (const auto& t : other.triangles) mesh.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  return mesh;
}

// A floor with a round hole, of many small triangles; and what fills the hole.
TriangleMesh pierced_floor(double diameter, int sectors) {
  TriangleMesh mesh;
  const double outer = 0.4;
  constexpr int rings = 3;
  for (int ring = 0; ring <= rings; ++ring) {
    const double radius = diameter / 2 * std::pow(outer / (diameter / 2), double(ring) / rings);
    for (int k = 0; k < sectors; ++k) {
      const double angle = 2 * M_PI * k / sectors;
      mesh.positions.emplace_back(radius * std::cos(angle), 0, radius * std::sin(angle));
    }
  }
  for (int ring = 0; ring < rings; ++ring) {
    for (int k = 0; k < sectors; ++k) {
      const int a = ring * sectors + k, b = ring * sectors + (k + 1) % sectors;
      mesh.triangles.push_back({a, b, b + sectors});
      mesh.triangles.push_back({a, b + sectors, a + sectors});
    }
  }
  return mesh;
}
TriangleMesh disc(double diameter, int sectors) {
  TriangleMesh mesh = pierced_floor(diameter, sectors);
  mesh.triangles.clear();
  for (int k = 2; k < sectors; ++k) mesh.triangles.push_back({0, k - 1, k});
  return mesh;
}

// A floor of many small triangles: all of it is wall, and no gap.
TriangleMesh fine_floor(double half, int pieces) {
  TriangleMesh mesh;
  const double step = 2 * half / pieces;
  for (int i = 0; i < pieces; ++i) {
    for (int j = 0; j < pieces; ++j) {
      const double x = -half + step * i, z = -half + step * j;
      add_quad(mesh, {x, 0, z}, {x, 0, z + step}, {x + step, 0, z + step}, {x + step, 0, z});
    }
  }
  return mesh;
}

BoundaryMotion motion_of(std::vector<Keyframe> keyframes,
                         BoundaryMotion::Interpolation how = BoundaryMotion::Interpolation::linear) {
  BoundaryMotion motion;
  motion.keyframes = std::move(keyframes);
  motion.interpolation = how;
  return motion;
}

struct Target {
  std::string name;
  TriangleMesh wall;
  std::vector<FluidBody> bodies;
};

const Vec3 low(-0.1, 0.03, -0.1), high(0.1, 0.23, 0.1);

std::vector<Target> targets() {
  const auto from_above = [](const Vec3& velocity) { return block(low, high, velocity); };
  return {
      {"sheet from both sides", sheet(0.3, 0), {from_above({0, -4, 0}), block(-high, -low, {0, 4, 0})}},
      {"sheet from both sides, one after the other",
       sheet(0.3, 0.001),
       {from_above({0, -4, 0}), block({-0.11, -0.33, -0.08}, {0.08, -0.13, 0.1}, {0.5, 4, 0})}},
      {"grazed sheet", sheet(0.5, 0), {from_above({4, -1, 0.5})}},
      {"sharp edge, 20 degrees", wedge(20, 1), {from_above({0.3, -4, 0})}},
      {"edge, 90 degrees", wedge(90, 1), {from_above({0, -4, 1})}},
      {"spike", spike(), {from_above({0.1, -4, 0.1})}},
      {"groove, 30 degrees", wedge(30, -1), {block({-0.06, 0.3, -0.1}, {0.06, 0.45, 0.1}, {0, -4, 0.5})}},
      {"groove, 90 degrees", wedge(90, -1), {block({-0.1, 0.2, -0.1}, {0.1, 0.4, 0.1}, {0.2, -4, 0.5})}},
      {"corner of a box, from outside", closed_box({0, -0.6, -0.6}, {0.6, 0, 0}), {from_above({1.5, -3.5, -1.5})}},
      {"corner of a box, from inside",
       closed_box({-0.3, -0.2, -0.3}, {0.2, 0.3, 0.2}),
       {block({-0.1, -0.05, -0.1}, {0.1, 0.15, 0.1}, {2.3, -2.3, 2.3})}},
      {"slot of half a spacing", slotted_floor(0.5 * spacing), {from_above({0, -4, 0})}},
  };
}

class TightWalls : public testing::TestWithParam<Target> {};

TEST_P(TightWalls, NothingPasses) {
  const Outcome outcome = shoot(shot(GetParam().wall, GetParam().bodies), 0.15);
  EXPECT_EQ(outcome.passed, 0);
  RecordProperty("held_by_the_guard", static_cast<int>(outcome.statistics.wall_crossings));
  RecordProperty("greatest_density_percent", static_cast<int>(100 * outcome.greatest_density));
  EXPECT_EQ(outcome.statistics.wall_crossings, 0U);
  EXPECT_LT(outcome.greatest_density, 1.5);
  EXPECT_GT(outcome.statistics.steps, 100U);
}

INSTANTIATE_TEST_SUITE_P(Shots, TightWalls, testing::ValuesIn(targets()), [](const auto& instance) {
  std::string name = instance.param.name;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !std::isalnum(c); }, '_');
  return name;
});

struct Gap {
  std::string name;
  TriangleMesh wall, mouth;
};

std::vector<Gap> gaps(double width) {
  const double w = width * spacing;
  return {{"slot between sheets", slotted_floor(w), slot(w)},
          {"slot between blocks", two_blocks(w), slot(w)},
          {"round hole", pierced_floor(w, 17), disc(w, 17)}};
}

TEST(Gaps, NarrowerThanASpacingLetNothingThrough) {
  for (const double width : {0.02, 0.25, 0.5, 0.75, 0.9}) {
    for (const Gap& gap : gaps(width)) {
      for (const double speed : {2.0, 8.0}) {
        if (speed > 2 && width != 0.25 && width != 0.9) continue;
        const SimulationSetup setup =
            shot(gap.wall, {block({-0.045, 0.03, -0.045}, {0.045, 0.12, 0.045}, {0.1, -speed, 0})});
        const Outcome outcome = shoot(setup, 0.15 / speed, gap.mouth);
        EXPECT_EQ(outcome.through_mouth, 0) << gap.name << ' ' << width << ' ' << speed;
        EXPECT_EQ(outcome.passed, 0) << gap.name << ' ' << width << ' ' << speed;
        EXPECT_EQ(outcome.statistics.wall_crossings, 0U) << gap.name << ' ' << width << ' ' << speed;
      }
    }
  }
}

TEST(Gaps, OfMovingWallsLetNothingThrough) {
  for (const double width : {0.25, 0.9}) {
    for (const Gap& gap : gaps(width)) {
      SimulationSetup setup = shot(gap.wall, {block({-0.06, 0.03, -0.06}, {0.06, 0.15, 0.06}, Vec3::Zero())});
      setup.boundaries[0].motion = motion_of({{0, Vec3::Zero(), Vec3::Zero()}, {0.1, Vec3(0, 0.3, 0), Vec3(0, 0, 60)}});
      const Outcome outcome = shoot(setup, 0.08, gap.mouth);
      EXPECT_EQ(outcome.through_mouth, 0) << gap.name << ' ' << width;
      EXPECT_EQ(outcome.passed, 0) << gap.name << ' ' << width;
    }
  }
}

TEST(Gaps, WiderOnesLetFluidThrough) {
  for (std::size_t kind = 0; kind < 3; ++kind) {
    int before = 0;
    for (const double width : {2.0, 3.0}) {
      const Gap gap = gaps(width)[kind];
      SimulationSetup setup = shot(gap.wall, {block({-0.12, 0.015, -0.12}, {0.12, 0.195, 0.12}, Vec3::Zero())});
      setup.settings.gravity = {0, -9.81, 0};
      const Outcome outcome = shoot(setup, 0.2, gap.mouth);
      EXPECT_EQ(outcome.passed, 0) << gap.name;
      EXPECT_EQ(outcome.statistics.kept_out_of_gaps, 0U) << gap.name << ' ' << width;
      EXPECT_GT(outcome.through_mouth, before) << gap.name << ' ' << width;
      before = outcome.through_mouth;
    }
  }
}

TEST(Gaps, AreNotSeenWhereThereAreNone) {
  // Fluid that falls on a floor of triangles smaller than its particles, and into the corners of a box.
  SimulationSetup setup = shot(fine_floor(0.3, 30), {block({-0.09, 0.03, -0.09}, {0.09, 0.21, 0.09}, {0.5, -3, 0.4})});
  EXPECT_EQ(shoot(setup, 0.06).statistics.kept_out_of_gaps, 0U);
  setup.boundaries = {tank(closed_box({-0.1, 0, -0.1}, {0.12, 0.3, 0.12}), 0)};
  const Outcome outcome = shoot(setup, 0.15);
  EXPECT_EQ(outcome.statistics.kept_out_of_gaps, 0U);
  EXPECT_EQ(outcome.passed, 0);
}

TEST(Gaps, FluidBetweenCloseWallsStaysCalm) {
  // A sheet of fluid, one particle thick, between two plates, one spacing and a little more apart.
  for (const double gap : {1.0, 1.2, 1.5}) {
    SimulationSetup setup = shot(sheet(0.4, 0.5 * gap * spacing),
                                 {block({-0.15, -0.5 * spacing, -0.15}, {0.15, 0.5 * spacing, 0.15}, Vec3::Zero())});
    setup.boundaries.push_back({sheet(0.4, -0.5 * gap * spacing), 0});
    setup.settings.max_speed = 3;
    const Outcome outcome = shoot(setup, 0.1);
    EXPECT_EQ(outcome.passed, 0) << gap;
    for (const Vec3& v : outcome.end.velocities) EXPECT_LT(v.norm(), 3) << gap;
  }
}

// Gaps between a wall that moves and others. What moves is the last wall, and takes the mouth along.

Boundary moved(const TriangleMesh& mesh, const Vec3& velocity, double turns = 0) {
  Boundary wall{mesh, 0};
  wall.motion = motion_of({{0, Vec3::Zero(), Vec3::Zero()}, {1, velocity, Vec3(0, 0, 360 * turns)}});
  return wall;
}

// A gate across a channel along x, `width` above the floor y = 0, as thick as asked; and what is beneath it, as deep as
// it may rise.
TriangleMesh gate(double width, double thickness) {
  return closed_box({-thickness / 2, width, -0.2}, {thickness / 2, 0.4, 0.2});
}
TriangleMesh beneath(double width) {
  TriangleMesh mesh;
  add_quad(mesh, {0, -0.1, -0.4}, {0, -0.1, 0.4}, {0, width, 0.4}, {0, width, -0.4});
  return mesh;
}

SimulationSetup channel(const FluidBody& body) {
  SimulationSetup setup = shot(closed_box({-0.2, 0, -0.06}, {0.3, 0.4, 0.06}), {body});
  setup.settings.max_speed = 4;
  return setup;
}

TEST(Gaps, UnderAGateLetNothingThrough) {
  struct Shot {
    double thickness, speed, rise;
  };
  for (const double width : {0.02, 0.3, 0.9}) {
    for (const auto& [thickness, speed, rise] :
         {Shot{0.5, 2, 0}, Shot{0.5, 8, 0.02}, Shot{2, 8, 0}, Shot{2, 2, 0.02}}) {
      const double x = -0.5 * thickness * spacing - 0.015;
      SimulationSetup setup = shot(sheet(0.4, 0), {block({x - 0.09, 0, -0.045}, {x, 0.06, 0.045}, {speed, -0.1, 0})});
      setup.boundaries.push_back(moved(gate(width * spacing, thickness * spacing), {0, rise, 0}));
      const Outcome outcome = shoot(setup, 0.15 / speed, beneath(width * spacing));
      const auto where = testing::Message() << width << ' ' << thickness << ' ' << speed << ' ' << rise;
      EXPECT_EQ(outcome.through_mouth, 0) << where;
      EXPECT_EQ(outcome.passed, 0) << where;
      EXPECT_EQ(outcome.statistics.squeezed_through, 0U) << where;
    }
  }
}

// A column of water presses against the gate.
Outcome press(double width, double thickness, double rise) {
  SimulationSetup setup = channel(block({-0.195, 0, -0.06}, {-0.045, 0.18, 0.06}, Vec3::Zero()));
  setup.settings.gravity = {0, -9.81, 0};
  setup.boundaries.push_back(moved(gate(width * spacing, thickness * spacing), {0, rise, 0}));
  return shoot(setup, 0.25, beneath(width * spacing));
}

TEST(Gaps, UnderAGateHoldAColumn) {
  for (const double width : {0.02, 0.3, 0.85}) {
    for (const bool rises : {false, true}) {
      const Outcome outcome = press(width, rises ? 0.5 : 2.0, rises ? 0.01 : 0.0);
      EXPECT_EQ(outcome.through_mouth, 0) << width << ' ' << rises;
      EXPECT_EQ(outcome.passed, 0) << width << ' ' << rises;
    }
  }
}

TEST(Gaps, UnderARaisedGateLetFluidThrough) {
  for (const double thickness : {0.5, 2.0}) {
    const Outcome outcome = press(3, thickness, 0);
    EXPECT_GT(outcome.through_mouth, 20) << thickness;
    EXPECT_EQ(outcome.passed, 0) << thickness;
    EXPECT_EQ(outcome.statistics.kept_out_of_gaps, 0U) << thickness;
  }
}

TEST(Gaps, AroundAPaddleLetNothingThrough) {
  // It sweeps along a tank, half a spacing from its sides, through fluid four layers high or through a film.
  constexpr double side_gap = 0.5 * spacing;
  for (const double width : {0.5, 0.9}) {
    const double gap = width * spacing;
    const TriangleMesh paddle = closed_box({-0.195, gap, -0.06 + side_gap}, {-0.165, 0.3, 0.06 - side_gap});
    TriangleMesh mouth;
    add_quad(mouth, {-0.18, -0.1, -0.1}, {-0.18, -0.1, 0.1}, {-0.18, gap, 0.1}, {-0.18, gap, -0.1});
    for (const double side : {-1.0, 1.0}) {
      const double edge = side * (0.06 - side_gap);
      add_quad(mouth, {-0.18, gap, edge}, {-0.18, 0.3, edge}, {-0.18, 0.3, side * 0.1}, {-0.18, gap, side * 0.1});
    }
    for (const double height : {0.03, 0.12}) {
      for (const double speed : {0.5, 3.0}) {
        SimulationSetup setup = channel(block({-0.15, 0, -0.06}, {0.06, height, 0.06}, Vec3::Zero()));
        setup.settings.gravity = {0, -9.81, 0};
        setup.boundaries.push_back(moved(paddle, {speed, 0, 0}));
        const Outcome outcome = shoot(setup, 0.15 / speed, mouth);
        EXPECT_EQ(outcome.through_mouth, 0) << width << ' ' << height << ' ' << speed;
        EXPECT_EQ(outcome.passed, 0) << width << ' ' << height << ' ' << speed;
        EXPECT_EQ(outcome.statistics.squeezed_through, 0U) << width << ' ' << height << ' ' << speed;
      }
    }
  }
}

TEST(Gaps, AroundARotorLetNothingThrough) {
  // A sheet turns in a drum that rests, half a spacing from its ends.
  constexpr double radius = 0.15, depth = 0.06;
  constexpr int sides = 24;
  TriangleMesh drum;
  const auto at = [](int k, double z) {
    return Vec3(radius * std::cos(2 * M_PI * k / sides), radius * std::sin(2 * M_PI * k / sides), z);
  };
  for (int k = 0; k < sides; ++k) {
    add_quad(drum, at(k, -depth), at(k + 1, -depth), at(k + 1, depth), at(k, depth));
    add_quad(drum, at(k, -depth), at(k + 1, -depth), {0, 0, -depth}, {0, 0, -depth});
    add_quad(drum, at(k, depth), at(k + 1, depth), {0, 0, depth}, {0, 0, depth});
  }
  for (const double width : {0.5, 0.9}) {
    const double tip = radius - width * spacing, end = depth - 0.5 * spacing;
    TriangleMesh rotor, mouth;
    add_quad(rotor, {-tip, 0, -end}, {tip, 0, -end}, {tip, 0, end}, {-tip, 0, end});
    for (const double side : {-1.0, 1.0}) {
      add_quad(mouth, {side * tip, 0, -depth}, {side * 0.2, 0, -depth}, {side * 0.2, 0, depth}, {side * tip, 0, depth});
      add_quad(mouth, {-tip, 0, side * end}, {tip, 0, side * end}, {tip, 0, side * 0.1}, {-tip, 0, side * 0.1});
    }
    for (const double turns : {1.0, -1.5}) {
      SimulationSetup setup = shot(drum, {block({-0.09, 0.015, -0.06}, {0.09, 0.105, 0.06}, Vec3::Zero())});
      setup.settings.gravity = {0, -9.81, 0};
      setup.settings.max_speed = 4;
      setup.boundaries.push_back(moved(rotor, Vec3::Zero(), turns));
      const Outcome outcome = shoot(setup, 0.2, mouth);
      EXPECT_EQ(outcome.through_mouth, 0) << width << ' ' << turns;
      EXPECT_EQ(outcome.passed, 0) << width << ' ' << turns;
      EXPECT_EQ(outcome.statistics.squeezed_through, 0U) << width << ' ' << turns;
    }
  }
}

// One half of a mesh of two parts of equal size.
TriangleMesh half(const TriangleMesh& mesh, int which) {
  const int points = static_cast<int>(mesh.positions.size() / 2), first = which * points;
  TriangleMesh part;
  part.positions.assign(mesh.positions.begin() + first, mesh.positions.begin() + first + points);
  for (const auto& t : mesh.triangles) {
    if (t[0] / points == which) part.triangles.push_back({t[0] - first, t[1] - first, t[2] - first});
  }
  return part;
}

TEST(Gaps, BetweenMoversThatSlidePastEachOther) {
  for (const double width : {0.02, 0.25, 0.9}) {
    for (const TriangleMesh& both : {slotted_floor(width * spacing), two_blocks(width * spacing)}) {
      for (const double speed : {0.3, 2.0}) {
        SimulationSetup setup = shot(half(both, 0), {block({-0.06, 0.03, -0.06}, {0.06, 0.12, 0.06}, {0.1, -2, 0})});
        setup.boundaries = {moved(half(both, 0), {0, 0.5, -speed}), moved(half(both, 1), {0, 0.5, speed})};
        const Outcome outcome = shoot(setup, 0.06, slot(width * spacing));
        EXPECT_EQ(outcome.through_mouth, 0) << width << ' ' << speed;
        EXPECT_EQ(outcome.passed, 0) << width << ' ' << speed;
      }
    }
  }
}

TEST(Gaps, ThatCloseOnFluidLetItOut) {
  // A plate comes down on a floor, to 0.6 spacings.
  SimulationSetup setup = shot(sheet(0.4, 0), {block({-0.06, 0, -0.06}, {0.06, 0.06, 0.06}, Vec3::Zero())});
  setup.settings.max_speed = 6;
  setup.boundaries.push_back(tank(closed_box({-0.06, 0.068, -0.06}, {0.06, 0.1, 0.06}), 0));
  setup.boundaries[1].motion = motion_of({{0, Vec3::Zero(), Vec3::Zero()}, {0.25, Vec3(0, -0.05, 0), Vec3::Zero()}},
                                         BoundaryMotion::Interpolation::smooth);
  const Outcome outcome = shoot(setup, 0.3);
  EXPECT_EQ(outcome.passed, 0);
  EXPECT_EQ(outcome.statistics.squeezed_through, 0U);
  const auto is_out = [](const Vec3& p) { return std::max(std::abs(p.x()), std::abs(p.z())) > 0.06; };
  const auto& places = outcome.end.positions;
  EXPECT_GT(std::count_if(places.begin(), places.end(), is_out), 30);
}

TEST(MovingTightWalls, ShakenBoxLosesNothing) {
  SimulationSetup setup = shot(closed_box({-0.12, -0.12, -0.12}, {0.12, 0.12, 0.12}),
                               {block({-0.12, -0.12, -0.12}, {0.12, 0.03, 0.12}, Vec3::Zero())});
  setup.settings.gravity = {0, -9.81, 0};
  std::vector<Keyframe> keys = {{0, Vec3::Zero(), Vec3::Zero()}};
  for (int k = 1; k <= 8; ++k) {
    const double side = k % 2 == 0 ? 1 : -1;
    keys.push_back({0.05 * k, Vec3(0.06 * side, 0.03 * (k % 3), 0), Vec3(0, 0, 20 * side)});
  }
  setup.boundaries[0].motion = motion_of(keys, BoundaryMotion::Interpolation::smooth);
  const Outcome outcome = shoot(setup, 0.3);
  EXPECT_EQ(outcome.passed, 0);
  EXPECT_EQ(outcome.statistics.squeezed_through, 0U);
  const Pose pose = setup.boundaries[0].motion.pose(outcome.end.time);
  for (const Vec3& p : outcome.end.positions) EXPECT_LT(pose.to_rest(p).cwiseAbs().maxCoeff(), 0.12);
}

TEST(MovingTightWalls, DrumWithBafflesLosesNothing) {
  // A drum about the z axis, of twelve sides, with two thin baffles inside, open to one end into a resting disc.
  TriangleMesh drum;
  constexpr int sides = 12;
  const auto at = [](int k, double radius, double z) {
    return Vec3(radius * std::cos(2 * M_PI * k / sides), radius * std::sin(2 * M_PI * k / sides), z);
  };
  constexpr double radius = 0.15, depth = 0.09;
  for (int k = 0; k < sides; ++k) {
    add_quad(drum, at(k, radius, -depth), at(k + 1, radius, -depth), at(k + 1, radius, depth), at(k, radius, depth));
    add_quad(drum, at(k, radius, -depth), at(k + 1, radius, -depth), {0, 0, -depth}, {0, 0, -depth});
    add_quad(drum, at(k, radius, depth), at(k + 1, radius, depth), {0, 0, depth}, {0, 0, depth});
    if (k % 6 == 0) {
      add_quad(drum, at(k, radius, -depth), at(k, 0.08, -depth), at(k, 0.08, depth), at(k, radius, depth));
    }
  }
  SimulationSetup setup = shot(drum, {block({-0.09, -0.12, -0.075}, {0.09, -0.03, 0.075}, Vec3::Zero())});
  setup.settings.gravity = {0, -9.81, 0};
  setup.boundaries[0].motion = motion_of({{0, Vec3::Zero(), Vec3::Zero()}, {1, Vec3::Zero(), Vec3(0, 0, 720)}});
  const Outcome outcome = shoot(setup, 0.25);
  EXPECT_EQ(outcome.passed, 0);
  EXPECT_EQ(outcome.statistics.squeezed_through, 0U);
  for (const Vec3& p : outcome.end.positions) EXPECT_LT(std::hypot(p.x(), p.y()), radius);
}

TEST(MovingTightWalls, SheetThrustThroughFluid) {
  // A small sheet goes down through a block at rest and up again, faster than the fluid is.
  SimulationSetup setup = shot(closed_box({-0.12, -0.12, -0.12}, {0.12, 0.3, 0.12}),
                               {block({-0.12, -0.12, -0.12}, {0.12, 0.06, 0.12}, Vec3::Zero())});
  setup.settings.gravity = {0, -9.81, 0};
  setup.boundaries.push_back({sheet(0.06, 0.1), 0});
  setup.boundaries[1].motion = motion_of({{0, Vec3::Zero(), Vec3::Zero()},
                                          {0.1, Vec3(0, -0.17, 0), Vec3(0, 0, 15)},
                                          {0.2, Vec3(0, 0.1, 0), Vec3(0, 0, 0)}});
  const Outcome outcome = shoot(setup, 0.2);
  EXPECT_EQ(outcome.passed, 0);
  EXPECT_EQ(outcome.statistics.squeezed_through, 0U);
}

}  // namespace
}  // namespace flowskin::sph::tight_walls_test
