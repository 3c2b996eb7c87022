// Planted intersections must be found, and nothing else; against exact clipping in whole numbers.
#include "tracking/mesh/self_intersections.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "common/orientation.h"
#include "tests/tracking/exact_intersections.h"
#include "tests/tracking/mesh_test_shapes.h"

namespace flowskin::tracking::self_intersections_test {
namespace {

using test::both;
using test::Whole;
using Pairs = std::vector<std::array<int, 2>>;

Pairs pairs_of(const SurfaceGeometry& surface) { return self_intersections(surface.positions, surface.triangles); }

SurfaceGeometry ball(const Vec3& center, double radius = 1, double spacing = 0.15) {
  SurfaceGeometry surface = test::marched([&](const Vec3& x) { return radius - x.norm(); }, radius, spacing);
  for (Vec3& x : surface.positions) x += center;
  return surface;
}

// A number of so many bits, negative or not.
long long whole(test::Random& random, int bits) { return static_cast<long long>(std::ldexp(random.symmetric(), bits)); }

int sign(Whole value) { return (value > 0) - (value < 0); }

// --- the predicates ---

// Points of 40 bits that lie in the plane of a sliver or beside it by one unit: the sum in doubles, of 120 bits, knows
// nothing of the sign.
TEST(Orientation, IsExactNextToThePlane) {
  test::Random random(21);
  int zeros = 0, others = 0;
  for (int round = 0; round < 3000; ++round) {
    std::array<std::array<long long, 3>, 4> p{};
    const long long s = whole(random, 2), t = whole(random, 2);
    for (int k = 0; k < 3; ++k) {
      for (int i = 0; i < 2; ++i) p[i][k] = whole(random, 36);
      p[2][k] = 2 * p[1][k] - p[0][k] + whole(random, 2);
      p[3][k] = p[0][k] + s * (p[1][k] - p[0][k]) + t * (p[2][k] - p[0][k]) + (round % 3 == 0 ? 0 : whole(random, 1));
    }
    std::array<std::array<Whole, 3>, 3> d{};
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) d[i][k] = p[i][k] - p[3][k];
    }
    const Whole expected = d[0][0] * (d[1][1] * d[2][2] - d[1][2] * d[2][1]) +
                           d[0][1] * (d[1][2] * d[2][0] - d[1][0] * d[2][2]) +
                           d[0][2] * (d[1][0] * d[2][1] - d[1][1] * d[2][0]);
    std::array<Vec3, 4> x;
    // The unit may be any power of two within the range of coordinates.
    const int unit = round % 2 == 0 ? -150 : 60;
    for (int i = 0; i < 4; ++i) {
      for (int k = 0; k < 3; ++k) x[i][k] = std::ldexp(static_cast<double>(p[i][k]), unit);
    }
    ASSERT_EQ(orientation(x[0], x[1], x[2], x[3]), sign(expected)) << "round " << round;
    ASSERT_EQ(orientation(x[1], x[0], x[2], x[3]), -sign(expected)) << "round " << round;
    (expected == 0 ? zeros : others) += 1;
  }
  EXPECT_GT(zeros, 900);
  EXPECT_GT(others, 900);
}

TEST(Orientation, IsExactNextToTheLine) {
  test::Random random(22);
  int zeros = 0, others = 0;
  for (int round = 0; round < 3000; ++round) {
    std::array<std::array<long long, 2>, 3> p{};
    const long long s = whole(random, 4);
    for (int k = 0; k < 2; ++k) {
      for (int i = 0; i < 2; ++i) p[i][k] = whole(random, 44);
      p[2][k] = p[0][k] + s * (p[1][k] - p[0][k]) + (round % 3 == 0 ? 0 : whole(random, 1));
    }
    const Whole expected = static_cast<Whole>(p[0][0] - p[2][0]) * (p[1][1] - p[2][1]) -
                           static_cast<Whole>(p[0][1] - p[2][1]) * (p[1][0] - p[2][0]);
    std::array<Vec2, 3> x;
    for (int i = 0; i < 3; ++i) x[i] = Vec2(static_cast<double>(p[i][0]), static_cast<double>(p[i][1]));
    ASSERT_EQ(orientation(x[0], x[1], x[2]), sign(expected)) << "round " << round;
    (expected == 0 ? zeros : others) += 1;
  }
  EXPECT_GT(zeros, 900);
  EXPECT_GT(others, 900);
}

// Coordinates of very different size: differences that no double holds. det = (1 + e) 1 - 1 1 = e for the rows below.
TEST(Orientation, SeesWhatADifferenceOfDoublesLoses) {
  for (const double tiny : {1e-17, 1e-30, 1e-60}) {
    // d = (-tiny, 0, 0): the difference 1 - (-tiny) is not a double, and only tiny decides.
    EXPECT_EQ(orientation(Vec3(1, 1, 0), Vec3(1, 1, 1), Vec3(0, 0, 1), Vec3(-tiny, 0, 0)), sign_of(tiny)) << tiny;
    EXPECT_EQ(orientation(Vec3(1, 1, 0), Vec3(1, 1, 1), Vec3(0, 0, 1), Vec3(tiny, 0, 0)), -sign_of(tiny)) << tiny;
    EXPECT_EQ(orientation(Vec2(1, 1), Vec2(-1, -1), Vec2(tiny, 0)), orientation(Vec2(1, 1), Vec2(-1, -1), Vec2(1, 0)));
  }
}

// --- surfaces ---

TEST(SelfIntersections, NoneInSoundSurfaces) {
  EXPECT_EQ(pairs_of({}), Pairs{});
  EXPECT_EQ(pairs_of(test::tetrahedron()), Pairs{});
  EXPECT_EQ(pairs_of(ball({0, 0, 0})), Pairs{});
  EXPECT_EQ(pairs_of(both(ball({0, 0, 0}), ball({2.1, 0, 0}))), Pairs{});
  EXPECT_EQ(pairs_of(both(ball({0, 0, 0}), ball({0, 0, 0}, 0.5))), Pairs{});
}

// Two balls meet along a circle: each found triangle is near it, and every piece of the circle is near a found one.
TEST(SelfIntersections, OfTwoBallsAreAlongTheirCircle) {
  const double half = 0.7, radius = std::sqrt(1 - half * half), edge = 0.3;
  const SurfaceGeometry balls = both(ball({-half, 0, 0}), ball({half, 0, 0}));
  const Pairs pairs = pairs_of(balls);
  const int first_of_second = static_cast<int>(ball({0, 0, 0}).triangles.size());
  ASSERT_FALSE(pairs.empty());
  EXPECT_TRUE(std::is_sorted(pairs.begin(), pairs.end()));
  std::vector<Vec3> centers;
  for (const auto& [s, t] : pairs) {
    EXPECT_LT(s, first_of_second);
    EXPECT_GE(t, first_of_second);
    const Triangle& triangle = balls.triangles[s];
    centers.emplace_back((balls.positions[triangle[0]] + balls.positions[triangle[1]] + balls.positions[triangle[2]]) /
                         3);
    EXPECT_LT(std::hypot(centers.back().x(), std::hypot(centers.back().y(), centers.back().z()) - radius), edge);
  }
  for (int i = 0; i < 200; ++i) {
    const Vec3 place(0, radius * std::cos(i * M_PI / 100), radius * std::sin(i * M_PI / 100));
    EXPECT_TRUE(std::any_of(centers.begin(), centers.end(), [&](const Vec3& center) {
      return (center - place).norm() < edge;
    })) << i;
  }
}

TEST(SelfIntersections, OfANeedleThroughAFace) {
  const SurfaceGeometry face = {{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  const auto needle = [&](double x, double tip) {
    return both(face, {{{x, 0, 1}, {x + 1e-9, 0, 1}, {x, 0, tip}}, {{0, 1, 2}}});
  };
  EXPECT_EQ(pairs_of(needle(0, -1)), (Pairs{{0, 1}}));
  EXPECT_EQ(pairs_of(needle(0, 1e-12)), Pairs{});
  EXPECT_EQ(pairs_of(needle(0, 0)), (Pairs{{0, 1}}));  // its tip touches
  EXPECT_EQ(pairs_of(needle(2, -1)), Pairs{});         // beside the face
}

TEST(SelfIntersections, TouchingCountsUnlessTheVertexIsShared) {
  const std::vector<Vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 1}, {0, -1, 1}};
  EXPECT_EQ(pairs_of({corners, {{0, 1, 2}, {0, 3, 4}}}), Pairs{});
  // The same place, but another vertex.
  std::vector<Vec3> apart = corners;
  apart.emplace_back(0, 0, 0);
  EXPECT_EQ(pairs_of({apart, {{0, 1, 2}, {5, 3, 4}}}), (Pairs{{0, 1}}));
  // A vertex on another triangle's edge, and an edge that lies along one.
  EXPECT_EQ(
      pairs_of({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 0, 0}, {0.5, -1, 1}, {0.5, -1, -1}}, {{0, 1, 2}, {3, 4, 5}}}),
      (Pairs{{0, 1}}));
  EXPECT_EQ(
      pairs_of({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.25, 0, 0}, {2, 0, 0}, {0.5, -1, 1}}, {{0, 1, 2}, {3, 4, 5}}}),
      (Pairs{{0, 1}}));
}

TEST(SelfIntersections, NeighborsAtAVertexMayPierceEachOther) {
  // The edge opposite the common vertex 0 goes through the other triangle, or ends above it.
  const auto fan = [](double low) {
    return SurfaceGeometry{{{0, 0, 0}, {2, -1, 0}, {2, 1, 0}, {1, 0, 1}, {1, 0, low}}, {{0, 1, 2}, {0, 3, 4}}};
  };
  EXPECT_EQ(pairs_of(fan(-1)), (Pairs{{0, 1}}));
  EXPECT_EQ(pairs_of(fan(0)), (Pairs{{0, 1}}));
  EXPECT_EQ(pairs_of(fan(1e-12)), Pairs{});
  // The other way round: the common point leaves through the edge of the first.
  const SurfaceGeometry far = {{{0, 0, 0}, {1, -1, 0}, {1, 1, 0}, {5, 0, 1}, {5, 0, -1}}, {{0, 1, 2}, {0, 3, 4}}};
  EXPECT_EQ(pairs_of(far), (Pairs{{0, 1}}));
}

TEST(SelfIntersections, NeighborsAtAVertexInOnePlane) {
  const auto fan = [](const Vec3& c, const Vec3& d) {
    return SurfaceGeometry{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, c, d}, {{0, 1, 2}, {0, 3, 4}}};
  };
  EXPECT_EQ(pairs_of(fan({0, 1, 0}, {-1, 1, 0})), Pairs{});
  EXPECT_EQ(pairs_of(fan({2, 1, 0}, {0, 1, 0})), (Pairs{{0, 1}}));
  EXPECT_EQ(pairs_of(fan({2, 2, 0}, {0, 1, 0})), (Pairs{{0, 1}}));          // along the edge 0-2
  EXPECT_EQ(pairs_of(fan({0.5, 0.2, 0}, {0.5, 0.3, 0})), (Pairs{{0, 1}}));  // inside
}

TEST(SelfIntersections, AFoldedSheet) {
  const auto sheet = [](const Vec3& flap) {
    return SurfaceGeometry{{{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, flap}, {{0, 1, 2}, {1, 0, 3}}};
  };
  EXPECT_EQ(pairs_of(sheet({0.5, -1, 0})), Pairs{});  // flat
  EXPECT_EQ(pairs_of(sheet({0.5, 0, 1})), Pairs{});   // bent
  EXPECT_EQ(pairs_of(sheet({0.5, 1, 1e-12})), Pairs{});
  EXPECT_EQ(pairs_of(sheet({0.2, 0.1, 0})), (Pairs{{0, 1}}));
  EXPECT_EQ(pairs_of(sheet({7, 0.1, 0})), (Pairs{{0, 1}}));
  EXPECT_EQ(pairs_of(sheet({0.5, 1, 0})), (Pairs{{0, 1}}));
}

TEST(SelfIntersections, TheSameTriangleTwice) {
  EXPECT_EQ(pairs_of({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}}), (Pairs{{0, 1}}));
}

TEST(SelfIntersections, SheetsThatNearlyTouchDoNotMeet) {
  // Two sheets, tilted, so that nothing is along an axis; at most 1e-12 apart.
  const auto sheets = [](double distance) {
    SurfaceGeometry surface;
    constexpr int n = 12;
    for (int layer = 0; layer < 2; ++layer) {
      const int first = static_cast<int>(surface.positions.size());
      for (int i = 0; i <= n; ++i) {
        for (int j = 0; j <= n; ++j) {
          const double x = 0.1 * i + 0.03 * layer, y = 0.1 * j;
          surface.positions.emplace_back(x, y, 0.3 * x + 0.7 * y + layer * distance);
        }
      }
      test::add_grid_triangles(first, n, surface.triangles);
    }
    return surface;
  };
  EXPECT_EQ(pairs_of(sheets(1e-12)), Pairs{});
  EXPECT_EQ(pairs_of(sheets(-1e-12)), Pairs{});
  EXPECT_FALSE(pairs_of(sheets(0)).empty());
}

TEST(SelfIntersections, TrianglesWithoutAreaAreSegmentsOrPoints) {
  const SurfaceGeometry face = {{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  const auto with = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    return pairs_of(both(face, {{a, b, c}, {{0, 1, 2}}}));
  };
  EXPECT_EQ(with({0, 0, 1}, {0, 0, 2}, {0, 0, -1}), (Pairs{{0, 1}}));
  EXPECT_EQ(with({0, 0, 1}, {0, 0, 2}, {0, 0, 3}), Pairs{});
  EXPECT_EQ(with({0, 0, 0}, {0, 0, 0}, {0, 0, 0}), (Pairs{{0, 1}}));
  EXPECT_EQ(with({0, 0, 1e-9}, {0, 0, 1e-9}, {0, 0, 1e-9}), Pairs{});
  EXPECT_EQ(with({-2, 0, 0}, {0, 0, 0}, {2, 0, 0}), (Pairs{{0, 1}}));  // across, in its plane
  EXPECT_EQ(with({-2, 5, 0}, {0, 5, 0}, {2, 5, 0}), Pairs{});
  // On one line: end to end, and apart.
  const auto on_a_line = [](double x) {
    return pairs_of({{{0, 0, 0}, {2, 2, 2}, {1, 1, 1}, {x, x, x}, {4, 4, 4}, {3, 3, 3}}, {{0, 1, 2}, {3, 4, 5}}});
  };
  EXPECT_EQ(on_a_line(2), (Pairs{{0, 1}}));
  EXPECT_EQ(on_a_line(1.5), (Pairs{{0, 1}}));
  EXPECT_EQ(on_a_line(2 + 1e-12), Pairs{});
  // A cap: its middle corner on the opposite edge; its neighbours meet nothing but what they share.
  const SurfaceGeometry cap = {{{0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {1, -1, 0}}, {{0, 1, 2}, {1, 0, 3}}};
  EXPECT_EQ(pairs_of(cap), Pairs{});
  // It covers a neighbour's edge that is not its own.
  const SurfaceGeometry over = {{{0, 0, 0}, {2, 0, 0}, {3, 0, 0}, {1, -1, 0}, {3, -1, 0}},
                                {{0, 1, 2}, {0, 2, 4}, {0, 1, 3}}};
  EXPECT_EQ(pairs_of(over), (Pairs{{1, 2}}));
}

TEST(SelfIntersections, RefusesWhatIsNoMesh) {
  const std::vector<Vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const auto message = [](const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles) -> std::string {
    try {
      self_intersections(positions, triangles);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "nothing";
  };
  EXPECT_NE(message(corners, {{0, 1, 3}}).find("triangle 0 has an index out of range"), std::string::npos);
  EXPECT_NE(message(corners, {{0, 1, 2}, {0, 1, 1}}).find("triangle 1 names a vertex twice"), std::string::npos);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e61}) {
    std::vector<Vec3> positions = corners;
    positions[2][1] = bad;
    EXPECT_NE(message(positions, {{0, 1, 2}}).find("vertex 2"), std::string::npos);
  }
}

// --- random triangles, full of degenerate cases ---

struct Soup {
  std::vector<test::WholePoint> points;
  std::vector<Triangle> triangles;

  SurfaceGeometry surface() const {
    SurfaceGeometry result;
    for (const auto& [x, y, z] : points) result.positions.emplace_back(x, y, z);
    result.triangles = triangles;
    return result;
  }
};

// `extent` 1 to 8: from nearly all in contact to hardly any; few points, so that vertices and edges are shared.
Soup random_soup(std::uint64_t seed, int extent, int points, int triangles) {
  test::Random random(seed);
  const auto below = [&](int end) { return static_cast<int>((random.symmetric() + 1) / 2 * end); };
  Soup soup;
  for (int i = 0; i < points; ++i) {
    test::WholePoint point{};
    for (long long& value : point) value = below(2 * extent + 1) - extent;
    soup.points.push_back(point);
  }
  while (static_cast<int>(soup.triangles.size()) < triangles) {
    const Triangle triangle = {below(points), below(points), below(points)};
    if (triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0]) {
      soup.triangles.push_back(triangle);
    }
  }
  return soup;
}

TEST(SelfIntersections, AgreeWithExactClippingOfAllPairs) {
  int found = 0, none = 0;
  for (int seed = 0; seed < 300; ++seed) {
    const Soup soup = random_soup(100 + seed, 1 + seed % 8, 6 + seed % 40, 40);
    const Pairs expected = test::all_intersections(soup.points, soup.triangles);
    ASSERT_EQ(pairs_of(soup.surface()), expected) << "seed " << 100 + seed;
    found += static_cast<int>(expected.size());
    none += 40 * 39 / 2 - static_cast<int>(expected.size());
  }
  EXPECT_GT(found, 10000);
  EXPECT_GT(none, 10000);
}

// Pairs of triangles at a common vertex or edge, flat ones among them, each by itself.
TEST(SelfIntersections, OfNeighborsAgreeWithExactClipping) {
  for (int seed = 0; seed < 20000; ++seed) {
    const int shared = 1 + seed % 2;
    Soup soup = random_soup(5000 + seed, 1 + seed % 3, 6 - shared, 0);
    soup.triangles =
        shared == 1 ? std::vector<Triangle>{{0, 1, 2}, {3, 0, 4}} : std::vector<Triangle>{{0, 1, 2}, {3, 1, 0}};
    ASSERT_EQ(pairs_of(soup.surface()), test::all_intersections(soup.points, soup.triangles)) << "seed " << 5000 + seed;
  }
}

// --- what must not matter ---

TEST(SelfIntersections, DoNotDependOnNumbersPlaceOrThreads) {
  const Soup soup = random_soup(77, 8, 400, 300);
  const SurfaceGeometry surface = soup.surface();
  const Pairs pairs = pairs_of(surface);
  ASSERT_GT(pairs.size(), 100U);

  // Turned, mirrored, scaled and moved, exactly.
  SurfaceGeometry moved = surface;
  for (Vec3& x : moved.positions) x = 0x1p-20 * Vec3(-x[1], x[2], x[0]) + Vec3(1, -2, 3);
  EXPECT_EQ(pairs_of(moved), pairs);

  // Vertices and triangles in other orders.
  const int vertices = static_cast<int>(surface.positions.size()), count = static_cast<int>(surface.triangles.size());
  SurfaceGeometry shuffled = surface;
  for (int v = 0; v < vertices; ++v) shuffled.positions[v * 7 % vertices] = surface.positions[v];  // 7 divides neither
  for (int t = 0; t < count; ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    shuffled.triangles[t * 7 % count] = {b * 7 % vertices, c * 7 % vertices, a * 7 % vertices};
  }
  Pairs expected;
  for (const auto& [s, t] : pairs)
    expected.push_back({std::min(s * 7 % count, t * 7 % count), std::max(s * 7 % count, t * 7 % count)});
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(pairs_of(shuffled), expected);

  const int before = omp_get_max_threads();
  for (const int threads : {1, 2, 5}) {
    omp_set_num_threads(threads);
    EXPECT_EQ(pairs_of(surface), pairs) << threads << " threads";
  }
  omp_set_num_threads(before);
}

}  // namespace
}  // namespace flowskin::tracking::self_intersections_test
