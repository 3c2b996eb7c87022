// The metaball field against brute force, differences and theory.
#include "tracking/field/metaballs/metaball_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "common/hilbert.h"
#include "tests/tracking/field_test_bodies.h"

namespace flowskin::tracking::field_test {
namespace {

using test::lattice;
using test::Random;

struct Body {
  std::vector<Vec3> positions;
  std::vector<Vec3> velocities;
  FieldSettings settings;
  MetaballField field() const { return {positions, velocities, settings}; }
};

Body jittered_ball(double spacing = 0.1, double radius_in_spacings = 2.5) {
  Body body;
  body.positions = lattice(spacing, 5, 0.2, 11, [&](const Vec3& x) { return x.norm() < 4.5 * spacing; });
  Random random(12);
  for (std::size_t i = 0; i < body.positions.size(); ++i) body.velocities.push_back(random.vector());
  body.settings = default_field_settings(spacing, radius_in_spacings);
  body.settings.weight = 1.25;
  return body;
}

/// The jet of one kernel phi(s) = w (1 - s)^3, s = r^2 / sigma^2, by the chain rule in x, one particle after the other.
MotionJet brute_force_jet(const Body& body, const Vec3& x) {
  MotionJet jet;
  jet.moving_value = -body.settings.threshold;
  const double sigma2 = body.settings.radius * body.settings.radius;
  const double w = body.settings.weight;
  for (std::size_t i = 0; i < body.positions.size(); ++i) {
    const Vec3 d = x - body.positions[i];
    const double s = d.squaredNorm() / sigma2;
    if (s >= 1) continue;
    ++jet.neighbors;
    const double p1 = -3 * w * (1 - s) * (1 - s);
    const double p2 = 6 * w * (1 - s);
    const double p3 = -6 * w;
    const Vec3 ds = 2 * d / sigma2;
    const Mat3 dds = 2 / sigma2 * Mat3::Identity();
    const Mat3 hessian = p2 * ds * ds.transpose() + p1 * dds;
    std::array<Mat3, 3> third;
    for (int k = 0; k < 3; ++k) {
      third[k] =
          p3 * ds[k] * ds * ds.transpose() + p2 * ds[k] * dds + p2 * dds.col(k) * ds.transpose() + p2 * ds * dds.row(k);
    }
    jet.moving_value += w * std::pow(1 - s, 3);
    jet.gradient += p1 * ds;
    jet.hessian += hessian;
    for (int k = 0; k < 3; ++k) jet.third[k] += third[k];
    if (body.velocities.empty()) continue;
    const Vec3& v = body.velocities[i];
    jet.value_rate -= p1 * ds.dot(v);
    jet.gradient_rate -= hessian * v;
    for (int k = 0; k < 3; ++k) jet.hessian_rate -= v[k] * third[k];
  }
  return jet;
}

void expect_close(const Mat3& a, const Mat3& b, double tolerance, const char* what) {
  EXPECT_LE((a - b).cwiseAbs().maxCoeff(), tolerance * (1e-300 + std::max(a.norm(), b.norm()))) << what;
}

void expect_same_jet(const MotionJet& a, const MotionJet& b, double tolerance) {
  EXPECT_NEAR(a.moving_value, b.moving_value, tolerance * (1 + std::abs(b.moving_value)));
  EXPECT_LE((a.gradient - b.gradient).norm(), tolerance * (1 + b.gradient.norm()));
  expect_close(a.hessian, b.hessian, tolerance, "hessian");
  for (int k = 0; k < 3; ++k) expect_close(a.third[k], b.third[k], tolerance, "third");
  EXPECT_NEAR(a.value_rate, b.value_rate, tolerance * (1 + std::abs(b.value_rate)));
  EXPECT_LE((a.gradient_rate - b.gradient_rate).norm(), tolerance * (1 + b.gradient_rate.norm()));
  expect_close(a.hessian_rate, b.hessian_rate, tolerance, "hessian rate");
  EXPECT_EQ(a.neighbors, b.neighbors);
}

TEST(Field, JetEqualsBruteForceSum) {
  for (const double radius : {0.9, 1.5, 2.0, 3.0, 6.0}) {
    const Body body = jittered_ball(0.1, radius);
    const MetaballField field = body.field();
    Random random(13);
    for (int i = 0; i < 200; ++i) {
      const Vec3 x = 0.6 * random.vector();
      SCOPED_TRACE(radius);
      expect_same_jet(field.motion_jet(x), brute_force_jet(body, x), 1e-12);
    }
  }
}

TEST(Field, ValueAndGradientEqualTheJets) {
  const Body body = jittered_ball();
  const MetaballField field = body.field();
  Random random(14);
  for (int i = 0; i < 200; ++i) {
    const Vec3 x = 0.6 * random.vector();
    const MotionJet jet = field.motion_jet(x);
    Vec3 gradient;
    EXPECT_NEAR(field.value(x, gradient), jet.moving_value, 1e-12);
    EXPECT_NEAR(field.value(x), jet.moving_value, 1e-12);
    EXPECT_LE((gradient - jet.gradient).norm(), 1e-12 * (1 + jet.gradient.norm()));
  }
}

/// Central difference of fourth order of any quantity of the field along direction `along`.
template <class Quantity>
auto difference(const Quantity& quantity, const Vec3& x, const Vec3& along, double step) {
  auto near = (quantity(Vec3(x + step * along)) - quantity(Vec3(x - step * along))).eval();
  auto far = (quantity(Vec3(x + 2 * step * along)) - quantity(Vec3(x - 2 * step * along))).eval();
  return ((8 * near - far) / (12 * step)).eval();
}

// The kernel is only twice continuously differentiable at its rim: points at which a particle's rim is nearer than the
// differences reach are passed over.
bool rim_is_near(const Body& body, const Vec3& x, double margin) {
  return std::any_of(body.positions.begin(), body.positions.end(), [&](const Vec3& particle) {
    return std::abs((x - particle).norm() - body.settings.radius) < margin;
  });
}

using Vec1 = Eigen::Matrix<double, 1, 1>;

TEST(Field, SpaceDerivativesEqualDifferences) {
  const Body body = jittered_ball();
  const MetaballField field = body.field();
  const double step = 2e-4 * body.settings.radius;
  Random random(15);
  int points = 0;
  while (points < 100) {
    const Vec3 x = 0.5 * random.vector();
    const MotionJet jet = field.motion_jet(x);
    if (jet.neighbors == 0 || rim_is_near(body, x, 3 * step)) continue;
    ++points;
    for (int k = 0; k < 3; ++k) {
      const Vec3 axis = Vec3::Unit(k);
      const double dv =
          difference([&](const Vec3& y) { return Vec1(field.motion_jet(y).moving_value); }, x, axis, step)[0];
      const Vec3 dg = difference([&](const Vec3& y) { return field.motion_jet(y).gradient; }, x, axis, step);
      const Mat3 dh = difference([&](const Vec3& y) { return field.motion_jet(y).hessian; }, x, axis, step);
      EXPECT_NEAR(dv, jet.gradient[k], 1e-6 * jet.gradient.norm());
      EXPECT_LE((dg - jet.hessian.col(k)).norm(), 1e-6 * jet.hessian.norm());
      EXPECT_LE((dh - jet.third[k]).norm(), 1e-6 * jet.third[k].norm());
    }
  }
}

TEST(Field, TimeDerivativesEqualDifferences) {
  const Body body = jittered_ball();
  const MetaballField field = body.field();
  const double step = 2e-4 * body.settings.radius;  // s; speeds are below 2 m/s
  std::vector<MetaballField> moved;
  for (const double t : {-2 * step, -step, step, 2 * step}) {
    std::vector<Vec3> positions = body.positions;
    for (std::size_t i = 0; i < positions.size(); ++i) positions[i] += t * body.velocities[i];
    moved.emplace_back(positions, body.velocities, body.settings);
  }
  Random random(16);
  int points = 0;
  while (points < 100) {
    const Vec3 x = 0.5 * random.vector();
    const MotionJet jet = field.motion_jet(x);
    if (jet.neighbors == 0 || rim_is_near(body, x, 4 * step)) continue;
    ++points;
    std::array<MotionJet, 4> jets;
    for (int i = 0; i < 4; ++i) jets[i] = moved[i].motion_jet(x);
    const auto rate = [&](const auto& part) {
      return ((8 * (part(jets[2]) - part(jets[1])) - (part(jets[3]) - part(jets[0]))) / (12 * step)).eval();
    };
    const double dv = rate([](const MotionJet& j) { return Vec1(j.moving_value); })[0];
    const Vec3 dg = rate([](const MotionJet& j) { return j.gradient; });
    const Mat3 dh = rate([](const MotionJet& j) { return j.hessian; });
    EXPECT_NEAR(dv, jet.value_rate, 1e-6 * (std::abs(jet.value_rate) + jet.gradient.norm()));
    EXPECT_LE((dg - jet.gradient_rate).norm(), 1e-6 * jet.gradient_rate.norm());
    EXPECT_LE((dh - jet.hessian_rate).norm(), 1e-6 * jet.hessian_rate.norm());
  }
}

TEST(Field, NeighborsEqualBruteForce) {
  const Body body = jittered_ball();
  const MetaballField field = body.field();
  Random random(17);
  std::vector<int> found;
  for (const double radius : {0.01, 0.1, 0.25, 0.7, 5.0}) {
    for (int i = 0; i < 50; ++i) {
      const Vec3 x = 0.7 * random.vector();
      std::vector<int> expected;
      for (std::size_t k = 0; k < body.positions.size(); ++k) {
        if ((body.positions[k] - x).squaredNorm() < radius * radius) expected.push_back(static_cast<int>(k));
      }
      field.neighbors(x, radius, found);
      EXPECT_EQ(found, expected);
    }
  }
  field.neighbors(Vec3::Zero(), 0, found);
  EXPECT_TRUE(found.empty());
}

TEST(Field, FarStraysDoNotHideNeighbors) {
  Body body = jittered_ball();
  body.positions.insert(body.positions.begin() + 7, Vec3(3e7, -1e7, 2e7));
  body.positions.emplace_back(-5e6, 1e3, 0);
  body.velocities.resize(body.positions.size(), Vec3::UnitX());
  const MetaballField field = body.field();
  Random random(18);
  for (int i = 0; i < 50; ++i) {
    const Vec3 x = 0.5 * random.vector();
    expect_same_jet(field.motion_jet(x), brute_force_jet(body, x), 1e-12);
  }
  EXPECT_EQ(field.motion_jet(Vec3(3e7, -1e7, 2e7)).neighbors, 1);
}

TEST(Field, DoesNotDependOnTheOrderOfQueries) {
  const Body body = jittered_ball();
  const MetaballField field = body.field();
  std::vector<Vec3> points;
  Random random(19);
  for (int i = 0; i < 300; ++i) points.emplace_back(0.5 * random.vector());
  std::vector<MotionJet> forward(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) forward[i] = field.motion_jet(points[i]);
  const auto count = static_cast<std::ptrdiff_t>(points.size());
#pragma omp parallel for schedule(dynamic, 1) num_threads(3)
  for (std::ptrdiff_t i = count - 1; i >= 0; --i) {
    const MotionJet jet = field.motion_jet(points[i]);
    EXPECT_EQ(jet.moving_value, forward[i].moving_value);
    EXPECT_EQ(jet.hessian_rate, forward[i].hessian_rate);
    EXPECT_EQ(jet.third[1], forward[i].third[1]);
  }
}

TEST(Field, WithoutVelocitiesNothingMoves) {
  Body body = jittered_ball();
  body.velocities.clear();
  const MotionJet jet = body.field().motion_jet(Vec3(0.1, 0.4, 0));
  EXPECT_GT(jet.gradient.norm(), 0);
  EXPECT_EQ(jet.value_rate, 0);
  EXPECT_EQ(jet.gradient_rate, Vec3::Zero());
  EXPECT_EQ(jet.hessian_rate, Mat3::Zero());
}

TEST(Field, DegenerateBodiesAreDefined) {
  const FieldSettings settings{1.0, 0.3, 1.0};
  const MetaballField empty({}, {}, settings);
  EXPECT_EQ(empty.value(Vec3::Zero()), -0.3);
  EXPECT_EQ(empty.motion_jet(Vec3::Zero()).neighbors, 0);

  const MetaballField coincident(std::vector<Vec3>(100, Vec3(1, 2, 3)), {}, settings);
  EXPECT_NEAR(coincident.value(Vec3(1, 2, 3)), 100 - 0.3, 1e-12);
  EXPECT_EQ(coincident.motion_jet(Vec3(1.1, 2, 3)).neighbors, 100);

  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(coincident.value(Vec3(nan, 0, 0)), -0.3);
  EXPECT_EQ(coincident.value(Vec3(1e300, 0, 0)), -0.3);
  EXPECT_THROW(MetaballField({Vec3(nan, 0, 0)}, {}, settings), std::invalid_argument);
  EXPECT_THROW(MetaballField({Vec3::Zero()}, {Vec3::Zero(), Vec3::Zero()}, settings), std::invalid_argument);
  EXPECT_THROW(MetaballField({}, {}, FieldSettings{}), std::invalid_argument);
  EXPECT_THROW(MetaballField({}, {}, FieldSettings{1, nan, 1}), std::invalid_argument);
  EXPECT_THROW(default_field_settings(0), std::invalid_argument);
  EXPECT_THROW(default_field_settings(1, -2), std::invalid_argument);
}

TEST(Field, DefaultThresholdIsTheMeanHalfASpacingOutside) {
  for (const double radius : {2.0, 2.5, 3.0, 4.0}) {
    const FieldSettings settings = default_field_settings(1, radius);
    // Mean of the kernel over a plane at distance h: 2 pi int rho (1 - h^2 - rho^2)^3 drho = pi / 4 (1 - h^2)^4.
    double mean = 0;
    for (double h = 0.5 / radius; h < 1; h += 1 / radius) {
      mean += std::numbers::pi / 4 * std::pow(1 - h * h, 4) * radius * radius;
    }
    EXPECT_NEAR(settings.threshold, mean, 0.01 * mean) << radius;
  }
}

TEST(Field, HilbertCurveVisitsEveryCellOnceByUnitSteps) {
  constexpr int bits = 3;
  constexpr std::uint32_t side = 1U << bits;
  std::vector<Vec3> cells(side * side * side, Vec3::Constant(-1));
  for (std::uint32_t x = 0; x < side; ++x) {
    for (std::uint32_t y = 0; y < side; ++y) {
      for (std::uint32_t z = 0; z < side; ++z) cells.at(hilbert_index(x, y, z, bits)) = Vec3(x, y, z);
    }
  }
  for (std::size_t i = 1; i < cells.size(); ++i) EXPECT_EQ((cells[i] - cells[i - 1]).lpNorm<1>(), 1) << i;
}

}  // namespace
}  // namespace flowskin::tracking::field_test
