// Neighbourhoods of many points against the field's own lookup, which field_test.cpp checks by brute force.
#include "tracking/field/neighborhoods.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>

#include "common/hilbert.h"
#include "tests/tracking/field_test_bodies.h"
#include "tracking/advection/projection.h"
#include "tracking/field/metaballs/metaball_field.h"

namespace flowskin::tracking::neighborhoods_test {
namespace {

using test::Random;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<Vec3> ball() {
  return test::lattice(1, 6, 0.2, 51, [](const Vec3& x) { return x.norm() < 5.5; });
}

std::vector<Vec3> noise(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Vec3> vectors;
  for (std::size_t i = 0; i < count; ++i) vectors.push_back(random.vector());
  return vectors;
}

MetaballField whole() { return {ball(), noise(ball().size(), 52), default_field_settings(1)}; }

/// Three parts, one of them without velocities, one silent.
MetaballField in_parts() {
  std::vector<FieldPart> parts(3);
  parts[0] = {ball(), noise(ball().size(), 53), 0.4, -0.3};
  parts[1] = {ball(), {}, 0.6, 0.3};
  for (Vec3& x : parts[1].positions) x += Vec3(0.3, -0.1, 0.2);
  parts[2] = {{Vec3(1, 0, 0)}, {Vec3(1, 2, 3)}, 0, 0};
  return MetaballField(parts, default_field_settings(1));
}

/// In no spatial order: near the surface, inside and out, far away, twice in one place.
std::vector<Vec3> scattered_points() {
  std::vector<Vec3> points = noise(900, 54);
  for (Vec3& x : points) x *= 7;
  points.emplace_back(1e6, -3e6, 0);
  points.push_back(points[3]);
  return points;
}

void expect_same(const MetaballField& field, const LocalField& local, const Vec3& x) {
  EXPECT_EQ(local.value(x), field.value(x));
  Vec3 gradient, local_gradient;
  EXPECT_EQ(local.value(x, local_gradient), field.value(x, gradient));
  EXPECT_EQ(local_gradient, gradient);
  const MotionJet jet = field.motion_jet(x), local_jet = local.motion_jet(x);
  EXPECT_EQ(local_jet.moving_value, jet.moving_value);
  EXPECT_EQ(local_jet.hessian, jet.hessian);
  EXPECT_EQ(local_jet.third[2], jet.third[2]);
  EXPECT_EQ(local_jet.hessian_rate, jet.hessian_rate);
  EXPECT_EQ(local_jet.value_rate, jet.value_rate);
  EXPECT_EQ(local_jet.neighbors, jet.neighbors);
  EXPECT_EQ(local.particles()->moments(x).u_eee, field.moments(x).u_eee);
  std::vector<int> found, local_found;
  field.neighbors(x, field.settings().radius, found);
  local.particles()->neighbors(x, local_found);
  EXPECT_EQ(local_found, found);
}

TEST(Neighborhoods, GiveTheFieldBitForBitNearAndFar) {
  const std::vector<Vec3> points = scattered_points();
  const MetaballField one = whole(), several = in_parts();
  for (const MetaballField* field : {&one, &several}) {
    for (const double slack : {0.0, 0.3, 1.5}) {
      const Neighborhoods neighborhoods(*field, points, slack);
      Random random(55);
      for (int i = 0; i < static_cast<int>(points.size()); i += 7) {
        const LocalField& local = neighborhoods.at(i);
        expect_same(*field, local, points[i]);
        // Within the slack, on its rim, and far beyond it.
        expect_same(*field, local, points[i] + slack * random.vector().normalized());
        expect_same(*field, local, points[i] + 3 * random.vector());
      }
    }
  }
}

TEST(Neighborhoods, VisitEveryPointOnceWithItsOwnField) {
  const MetaballField field = whole();
  const std::vector<Vec3> points = scattered_points();
  const Neighborhoods neighborhoods(field, points);
  const int threads = omp_get_max_threads();
  for (const int count : {1, 3}) {
    omp_set_num_threads(count);
    std::vector<std::atomic<int>> visits(points.size());
    std::vector<double> values(points.size());
    neighborhoods.for_each([&](int i, const LocalField& local) {
      ++visits[i];
      values[i] = local.value(points[i]);
    });
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_EQ(visits[i], 1);
      EXPECT_EQ(values[i], field.value(points[i]));
    }
  }
  omp_set_num_threads(threads);
}

TEST(Neighborhoods, AreDefinedForOddPointsAndBodies) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Vec3> points = {{nan, 0, 0}, {0, 0, 0},     {kInfinity, 0, 0}, {0.1, nan, 0},
                                    {0, 0, 1},   {1e300, 0, 0}, {-1e308, 1e308, 0}};
  const FieldSettings settings = default_field_settings(1);
  const MetaballField empty({}, {}, settings), coincident(std::vector<Vec3>(1000, Vec3(0, 0, 0.5)), {}, settings),
      partless(std::vector<FieldPart>{}, settings);
  for (const MetaballField* field : {&empty, &coincident, &partless}) {
    const Neighborhoods neighborhoods(*field, points, 0.1);
    for (int i = 0; i < static_cast<int>(points.size()); ++i) {
      EXPECT_EQ(neighborhoods.at(i).value(points[i]), field->value(points[i]));
      EXPECT_EQ(neighborhoods.at(i).value(Vec3::Zero()), field->value(Vec3::Zero()));
    }
    Neighborhoods(*field, {}).for_each([](int, const LocalField&) { ADD_FAILURE(); });
  }
}

TEST(Neighborhoods, HilbertOrderIsTheSortedOneWithTiesAscending) {
  const std::vector<Vec3> points = scattered_points();
  std::vector<Vec3> twice = points;
  twice.insert(twice.end(), points.begin(), points.end());
  for (const double cell : {1e-5, 0.3, 100.0}) {
    const std::vector<int> order = hilbert_order(twice, cell);
    Vec3 low = twice[0], high = twice[0];
    for (const Vec3& x : twice) {
      low = low.cwiseMin(x);
      high = high.cwiseMax(x);
    }
    const double extent = (high - low).maxCoeff();
    int bits = 1;
    while (bits < 21 && std::ldexp(cell, bits) <= extent) ++bits;
    const double last = std::ldexp(1.0, bits) - 1, scale = std::min(1 / cell, last / extent);
    const auto key = [&](int i) {
      const Vec3 at = ((twice[i] - low) * scale).cwiseMin(last);
      return hilbert_index(static_cast<std::uint32_t>(at.x()), static_cast<std::uint32_t>(at.y()),
                           static_cast<std::uint32_t>(at.z()), bits);
    };
    std::vector<int> expected(twice.size());
    std::iota(expected.begin(), expected.end(), 0);
    std::stable_sort(expected.begin(), expected.end(), [&](int a, int b) { return key(a) < key(b); });
    EXPECT_EQ(order, expected) << "cell " << cell;
  }
}

TEST(Neighborhoods, ProjectingTheMovedIsProjectingAll) {
  const MetaballField field = whole();
  const ProjectionSettings settings = default_projection(field.scale());
  std::vector<Vec3> some = noise(400, 56);
  for (Vec3& x : some) x = 5.8 * x.normalized();
  some[5] = Vec3(30, 0, 0);  // never gets there
  Projection projection = project_to_surface(field, settings, some);
  ASSERT_EQ(projection.failed, std::vector<int>{5});
  std::vector<int> moved = {5};
  Random random(57);
  for (int v = 0; v < 400; v += 9) {
    if (v % 27 != 0) moved.push_back(v);
    if (v % 27 != 0) some[v] += 0.3 * random.vector();
  }
  std::vector<Vec3> all = some;
  project_moved(field, settings, moved, some, projection);
  const Projection again = project_to_surface(field, settings, all);
  EXPECT_EQ(some, all);
  EXPECT_EQ(projection.normals, again.normals);
  EXPECT_EQ(projection.distances, again.distances);
  EXPECT_EQ(projection.failed, again.failed);
  EXPECT_EQ(projection.max_distance, again.max_distance);
}

}  // namespace
}  // namespace flowskin::tracking::neighborhoods_test
