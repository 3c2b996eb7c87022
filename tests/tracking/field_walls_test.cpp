// Walls in a metaball field: sums by another route, what a bare wall may do, and films that have a surface by them.
#include "tracking/field/metaballs/field_walls.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "tests/tracking/field_test_bodies.h"
#include "tracking/advection/particle_paths.h"
#include "tracking/extraction/extract_surface.h"
#include "tracking/extraction/sparse_grid.h"
#include "tracking/field/metaballs/metaball_field.h"
#include "tracking/field/neighborhoods.h"
#include "tracking/mesh/mesh_measures.h"
#include "tracking/tracker.h"

namespace flowskin::tracking::field_walls_test {
namespace {

using test::Random;

constexpr double kShare = 0.45;
const FieldSettings kField = default_field_settings(1);

/// A square lattice of points with spacing 1 on y = height.
std::vector<Vec3> plane(int half, double height = 0) {
  std::vector<Vec3> points;
  for (int i = -half; i <= half; ++i) {
    for (int k = -half; k <= half; ++k) points.emplace_back(i, height, k);
  }
  return points;
}

std::shared_ptr<const FieldWall> wall_of(std::vector<Vec3> points) {
  return std::make_shared<const FieldWall>(std::move(points), share_of_wall_point(kField, 1, kShare), kField.radius);
}

/// A film of so many layers on the plane y = 0, its particles displaced by up to 0.15 spacings, or 0.05 across.
std::vector<Vec3> film(int half, int layers, std::uint64_t seed = 3) {
  Random random(seed);
  std::vector<Vec3> points;
  for (int layer = 0; layer < layers; ++layer) {
    for (Vec3 x : plane(half, layer + 0.5)) points.push_back(x + Vec3(0.15, 0.05, 0.15).cwiseProduct(random.vector()));
  }
  return points;
}

std::vector<Vec3> noise(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Vec3> vectors;
  for (std::size_t i = 0; i < count; ++i) vectors.push_back(random.vector());
  return vectors;
}

/// Highest point of a mesh over the middle of the film.
double height_over_middle(const SurfaceGeometry& surface, double half) {
  double highest = -std::numeric_limits<double>::infinity();
  for (const Vec3& x : surface.positions) {
    if (std::abs(x.x()) < half && std::abs(x.z()) < half) highest = std::max(highest, x.y());
  }
  return highest;
}

// Particles of another share are a second way to the same sums.
TEST(FieldWalls, AddWhatParticlesOfTheirShareWould) {
  const std::vector<Vec3> particles = film(5, 2), points = plane(5);
  const MetaballField field({{particles, {}}}, kField, {wall_of(points)});
  const MetaballField other({{particles, {}}, {points, {}, share_of_wall_point(kField, 1, kShare), 0}}, kField);
  Random random(6);
  for (int i = 0; i < 200; ++i) {
    const Vec3 x = 5 * random.vector();
    Vec3 gradient;
    EXPECT_NEAR(field.value(x, gradient), other.value(x), 1e-12);
    EXPECT_NEAR(field.value(x), other.value(x), 1e-12);
    EXPECT_LE((gradient - other.motion_jet(x).gradient).norm(), 1e-12);
  }
}

TEST(FieldWalls, AreNoParticles) {
  const std::vector<Vec3> particles = film(5, 1);
  const MetaballField field({{particles, {}}}, kField, {wall_of(plane(5))});
  const MetaballField alone(particles, {}, kField);
  EXPECT_EQ(field.positions().size(), particles.size());
  EXPECT_TRUE(field.shares().empty());
  std::vector<int> found, expected;
  Random random(7);
  for (int i = 0; i < 50; ++i) {
    const Vec3 x = 4 * random.vector();
    field.neighbors(x, kField.radius, found);
    alone.neighbors(x, kField.radius, expected);
    EXPECT_EQ(found, expected);
    // The fluid moves, and is strained; the wall is not.
    EXPECT_EQ(field.moments(x).u2_ee, alone.moments(x).u2_ee);
    EXPECT_EQ(field.motion_jet(x).gradient, alone.motion_jet(x).gradient);
    EXPECT_EQ(field.motion_jet(x).hessian, alone.motion_jet(x).hessian);
  }
}

TEST(FieldWalls, ChangeNothingOutOfTheirReach) {
  const std::vector<Vec3> particles = film(5, 6);
  const MetaballField field({{particles, {}}}, kField, {wall_of(plane(8))});
  const MetaballField alone(particles, {}, kField);
  for (const double height : {2.51, 4.0, 6.0}) {
    const Vec3 x(0.3, height, 0.2);
    EXPECT_EQ(field.value(x), alone.value(x));
  }
}

TEST(FieldWalls, NeighborhoodsAndGridSeeTheSame) {
  const std::vector<Vec3> particles = film(6, 2);
  const MetaballField field({{particles, {}}}, kField, {wall_of(plane(9)), wall_of(plane(9, -1))});
  std::vector<Vec3> points = noise(300, 8);
  for (Vec3& x : points) x *= 6;
  const Neighborhoods near(field, points, 0.1);
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    EXPECT_EQ(near.at(i).value(points[i]), field.value(points[i]));
    Vec3 gradient, expected;
    near.at(i).value(points[i], gradient);
    field.value(points[i], expected);
    EXPECT_EQ(gradient, expected);
  }
  const std::shared_ptr<const SparseGrid> kept = field.on_grid(0.75);
  const SparseGrid& grid = *kept;
  int nodes = 0;
  for (const SparseGrid::Block& block : grid.blocks()) {
    for (int n = 0; n < SparseGrid::kSide; ++n) {
      const SparseGrid::Index node = {SparseGrid::kSide * block.place[0] + n, SparseGrid::kSide * block.place[1] + 2,
                                      SparseGrid::kSide * block.place[2] + 7 - n};
      EXPECT_NEAR(grid.value(node), field.value(grid.position(node)), 1e-12);
      ++nodes;
    }
  }
  EXPECT_GT(nodes, 100);
}

TEST(FieldWalls, BareWallsMakeNoSurface) {
  for (const double radius : {1.5, 2.0, 2.5, 3.0}) {
    SCOPED_TRACE(radius);
    const FieldSettings settings = default_field_settings(1, radius);
    const double share = share_of_wall_point(settings, 1, kShare);
    const auto wall = [&](double height) { return std::make_shared<const FieldWall>(plane(8, height), share, radius); };
    const std::vector<Vec3> far_away = {{100, 0, 0}};
    const MetaballField one({{far_away, {}}}, settings, {wall(0)});
    // The mean over the plane; between lattice points a small radius sees less of them.
    EXPECT_NEAR(one.value({0.25, 0, 0.25}) / settings.threshold, kShare - 1, 0.03);
    double highest = -1;
    for (const double gap : {0.1, 0.5, 1.0}) {
      const MetaballField two({{far_away, {}}}, settings, {wall(0), wall(gap)});
      for (double y = -0.5; y < 1.5; y += 0.1) {
        for (const double x : {0.0, 0.25, 0.5}) highest = std::max(highest, two.value({x, y, x}));
      }
    }
    EXPECT_LT(highest, 0);
  }
}

// One layer hardly reaches the threshold by itself: its surface is a heap of scraps, or none.
TEST(FieldWalls, FilmOfOneLayerOnAWallHasItsThickness) {
  for (const int layers : {1, 2, 3}) {
    SCOPED_TRACE(layers);
    const MetaballField field({{film(10, layers), {}}}, kField, {wall_of(plane(15))});
    const SurfaceGeometry surface = extract_raw_surface(field, 0.75);
    const MeshComponents parts = mesh_components(surface.positions, surface.triangles);
    EXPECT_EQ(parts.count, 1);
    const auto vertices = static_cast<long>(surface.positions.size());
    EXPECT_EQ(2 * vertices - static_cast<long>(surface.triangles.size()), 4) << "a sphere has no holes";
    EXPECT_NEAR(height_over_middle(surface, 8), layers, 0.2);
    for (const Vec3& x : surface.positions) EXPECT_GT(x.y(), -0.6) << "not far into the wall";
  }
  const SurfaceGeometry torn = extract_raw_surface(MetaballField(film(10, 1), {}, kField), 0.75);
  const auto vertices = static_cast<long>(torn.positions.size());
  EXPECT_NE(2 * vertices - static_cast<long>(torn.triangles.size()), 4);
}

TEST(FieldWalls, TrackerFollowsAFilmThatSlidesOverAWall) {
  const std::vector<Vec3> start = film(8, 1);
  const Vec3 velocity(1, 0, 0);
  const auto wall = std::make_shared<const Wall>(plane(20), 1.0);
  const auto particles = [&](double time) {
    Particles state;
    state.time = time;
    for (std::size_t i = 0; i < start.size(); ++i) {
      state.ids.push_back(i);
      state.positions.push_back(start[i] + time * velocity);
      state.velocities.push_back(velocity);
    }
    state.rest_positions = start;
    state.walls = {wall};
    return state;
  };
  TrackerSettings settings;
  settings.spacing = 1;
  settings.field = kField;
  settings.field.wall_share = kShare;
  Tracker tracker(settings, particles(0));
  for (int step = 1; step <= 10; ++step) {
    tracker.advance(particles(0.3 * step));
    EXPECT_EQ(tracker.report().components, 1);
    EXPECT_FALSE(tracker.report().reextracted) << tracker.report().reason;
  }
  const SurfaceMesh& mesh = tracker.mesh();
  std::vector<double> errors;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    if (mesh.positions[v].y() > 0.5)
      errors.push_back((mesh.positions[v] - mesh.rest_positions[v] - 3 * velocity).norm());
  }
  ASSERT_GT(errors.size(), 300U);
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.2);
}

KeyframeMotion rising() {
  KeyframeMotion motion;
  motion.keyframes = {{0, Vec3::Zero(), Vec3::Zero()}, {2, {0, 4, 0}, {0, 90, 0}}};
  motion.interpolation = KeyframeMotion::Interpolation::smooth;
  return motion;
}

TEST(FieldWalls, AreWhereTheirMotionPutsThemAtAnyTime) {
  const Wall wall(plane(3), 1, rising());
  for (const double time : {0.0, 0.3, 1.0, 1.9, 5.0}) {
    const Pose pose = rising().pose(time);
    const auto placed = wall.in_field(time, kField);
    ASSERT_EQ(placed->positions().size(), wall.points().size());
    for (std::size_t i = 0; i < wall.points().size(); ++i)
      EXPECT_EQ(placed->positions()[i], pose.place(wall.points()[i]));
    EXPECT_EQ(wall.in_field(time, kField), placed) << "not worked out twice";
  }
}

TEST(FieldWalls, KeepOneAnswerForEachShareAndRadius) {
  const Wall wall(plane(3), 1);
  const auto placed = wall.in_field(0, kField);
  EXPECT_EQ(wall.in_field(7, kField), placed) << "it rests";
  FieldSettings other = kField;
  other.wall_share = 0.2;
  EXPECT_NEAR(wall.in_field(0, other)->share() / placed->share(), 0.2 / kShare, 1e-12);
  EXPECT_EQ(wall.in_field(0, kField)->share(), placed->share());
}

// Between two states the walls are where their keyframes put them then, not at either state's place.
TEST(FieldWalls, PathsBetweenTwoStatesSeeThemInBetween) {
  Particles from, to;
  from.ids = to.ids = {0};
  from.positions = to.positions = {{0, 0.5, 0}};
  from.velocities = to.velocities = {Vec3::Zero()};
  from.walls = to.walls = {std::make_shared<const Wall>(plane(4), 1.0, rising())};
  to.time = 1;
  const ParticlePaths paths(from, to);
  for (const double time : {0.0, 0.5, 1.0}) {
    Particles between = from;
    between.time = time;
    const MetaballField field = paths.field(time, kField), expected = field_of(between, kField);
    ASSERT_EQ(field.walls().size(), 1U);
    for (const double y : {0.1, 0.7, 1.6}) EXPECT_EQ(field.value({0.2, y, 0.1}), expected.value({0.2, y, 0.1}));
  }
  FieldSettings without = kField;
  without.wall_share = 0;
  EXPECT_TRUE(paths.field(0.5, without).walls().empty());
  EXPECT_TRUE(field_of(from, without).walls().empty());
}

TEST(FieldWalls, BadOnesAreRefused) {
  const double nan = std::nan("");
  EXPECT_THROW(FieldWall({{nan, 0, 0}}, 1, 1), std::invalid_argument);
  EXPECT_THROW(FieldWall({{0, 0, 0}}, -1, 1), std::invalid_argument);
  EXPECT_THROW(FieldWall({{0, 0, 0}}, 1, 0), std::invalid_argument);
  EXPECT_THROW(Wall({{0, nan, 0}}, 1), std::invalid_argument);
  EXPECT_THROW(Wall({{0, 0, 0}}, 0), std::invalid_argument);
}

}  // namespace
}  // namespace flowskin::tracking::field_walls_test
