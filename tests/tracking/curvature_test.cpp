// K and H against surfaces whose curvature is known, and each form of their changes against the others.
#include "tracking/velocity/curvature.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/tracking/field_test_bodies.h"

namespace flowskin::tracking::curvature_test {
namespace {

using test::Random;

/// Gradient and Hessian of an implicit function that is positive inside.
struct Form {
  Vec3 q;
  Mat3 s;
};

void expect_curvatures(const Form& form, double gaussian, double mean) {
  const Curvatures kanatani = curvatures(form.q, form.s);
  const Curvatures belyaev = belyaev_curvatures(form.q, form.s);
  const double scale = std::abs(gaussian) + mean * mean;
  EXPECT_NEAR(kanatani.gaussian, gaussian, 1e-11 * scale);
  EXPECT_NEAR(kanatani.mean, mean, 1e-11 * std::sqrt(scale));
  EXPECT_NEAR(belyaev.gaussian, gaussian, 1e-11 * scale);
  EXPECT_NEAR(belyaev.mean, mean, 1e-11 * std::sqrt(scale));
}

TEST(Curvature, BallIsNegativeInMeanWithTheGradientInward) {
  for (const double radius : {0.01, 1.0, 30.0}) {
    const Vec3 x = radius * Vec3(2, -1, 2) / 3;  // f = R^2 - |x|^2
    expect_curvatures({-2 * x, -2 * Mat3::Identity()}, 1 / (radius * radius), -1 / radius);
  }
}

TEST(Curvature, Cylinder) {
  const double radius = 0.7;
  const Vec3 x = radius * Vec3(0.6, 0.8, 0);  // f = R^2 - x^2 - y^2
  expect_curvatures({-2 * x, Vec3(-2, -2, 0).asDiagonal()}, 0, -0.5 / radius);
}

TEST(Curvature, Torus) {
  const double large = 2, small = 0.6;
  for (double theta = 0.1; theta < 6.2; theta += 0.37) {
    for (double phi = 0.2; phi < 6; phi += 1.1) {
      const double rho = large + small * std::cos(theta);
      const Vec3 outward(std::cos(phi), std::sin(phi), 0);
      const Vec3 x = rho * outward + Vec3(0, 0, small * std::sin(theta));
      // f = r^2 - (rho - R)^2 - z^2
      const Mat3 flat = Vec3(1, 1, 0).asDiagonal();
      const Form form{-2 * x + 2 * large * outward,
                      -2 * Mat3::Identity() + 2 * large / rho * (flat - outward * outward.transpose())};
      const double cosine = std::cos(theta);
      expect_curvatures(form, cosine / (small * rho), -(large + 2 * small * cosine) / (2 * small * rho));
    }
  }
}

TEST(Curvature, Ellipsoid) {
  const Vec3 axes(1.5, 0.8, 0.5);
  const Vec3 squares = axes.cwiseAbs2();
  Random random(21);
  for (int i = 0; i < 100; ++i) {
    const Vec3 x = axes.cwiseProduct(random.vector().normalized());
    const Form form{-2 * x.cwiseQuotient(squares), Mat3((-2 * squares.cwiseInverse()).asDiagonal())};
    const double h2 = x.cwiseQuotient(squares).squaredNorm();
    const double product = squares.prod();
    expect_curvatures(form, 1 / (product * h2 * h2),
                      (x.squaredNorm() - squares.sum()) / (2 * product * std::pow(h2, 1.5)));
  }
}

struct RandomForm : Form {
  explicit RandomForm(Random& random) {
    q = random.vector();
    for (int i = 0; i < 3; ++i) s.col(i) = random.vector();
    s = (s + s.transpose()).eval();
  }
};

// Another function with the same zero set, f -> c f + d f^2 / 2: K and H belong to the surface, not to the function.
TEST(Curvature, BelongsToTheSurface) {
  Random random(22);
  for (int i = 0; i < 100; ++i) {
    const RandomForm form(random);
    const Curvatures c = curvatures(form.q, form.s);
    expect_curvatures({3 * form.q, 3 * form.s + 0.4 * form.q * form.q.transpose()}, c.gaussian, c.mean);
  }
}

TEST(Curvature, BelyaevEqualsKanatani) {
  Random random(23);
  for (int i = 0; i < 1000; ++i) {
    const RandomForm form(random);
    const Curvatures a = curvatures(form.q, form.s);
    const Curvatures b = belyaev_curvatures(form.q, form.s);
    EXPECT_NEAR(a.gaussian, b.gaussian, 1e-10 * (std::abs(a.gaussian) + a.mean * a.mean));
    EXPECT_NEAR(a.mean, b.mean, 1e-10 * (std::abs(a.mean) + 1));
  }
}

/// [FMM13, A.1] for one column of the 4-vectors df, with the power of |grad f| in the second term corrected: |grad f|^6
/// dK and 2 |grad f|^5 dH.
Curvatures appendix_a1(const Form& form, const Form& change) {
  const Vec3& q = form.q;
  const Mat3& s = form.s;
  const double g2 = q.squaredNorm();
  const double laplacian = s.trace();
  const double d_laplacian = change.s.trace();
  const double q_dq = q.dot(change.q);
  const double trace2 = (s * s).trace();
  const double d_trace2 = 2 * (s * change.s).trace();
  const double p = q.dot(s * s * q);
  const double d_p = 2 * change.q.dot(s * s * q) + q.dot((change.s * s + s * change.s) * q);
  const double r = q.dot(s * q);
  const double d_r = 2 * change.q.dot(s * q) + q.dot(change.s * q);
  const double gaussian = laplacian * g2 * g2 * d_laplacian - laplacian * laplacian * g2 * q_dq -
                          0.5 * (d_trace2 * g2 * g2 - 2 * trace2 * g2 * q_dq) + d_p * g2 - 4 * p * q_dq -
                          (d_laplacian * r + laplacian * d_r) * g2 + 4 * laplacian * r * q_dq;
  const double mean = g2 * g2 * d_laplacian - g2 * laplacian * q_dq - d_r * g2 + 3 * r * q_dq;
  return {gaussian / std::pow(g2, 3), mean / (2 * std::pow(g2, 2.5))};
}

TEST(Curvature, ChangesEqualAppendicesAndDifferences) {
  Random random(24);
  for (int i = 0; i < 500; ++i) {
    const RandomForm form(random);
    const RandomForm change(random);
    const Curvatures direct = CurvatureChange(form.q, form.s)(change.q, change.s);
    const Curvatures a1 = appendix_a1(form, change);
    const Curvatures a2 = BelyaevCurvatureChange(form.q, form.s)(change.q, change.s);
    const double g = form.q.norm();
    const double size = form.s.norm() / g * (change.s.norm() / g + form.s.norm() * change.q.norm() / (g * g));
    const double mean_size = change.s.norm() / g + form.s.norm() * change.q.norm() / (g * g);
    EXPECT_NEAR(direct.gaussian, a1.gaussian, 1e-10 * size);
    EXPECT_NEAR(direct.mean, a1.mean, 1e-10 * mean_size);
    EXPECT_NEAR(direct.gaussian, a2.gaussian, 1e-10 * size);
    EXPECT_NEAR(direct.mean, a2.mean, 1e-10 * mean_size);

    if (g < 0.3) continue;
    const double step = 1e-4;
    const auto at = [&](double t) { return curvatures(form.q + t * change.q, form.s + t * change.s); };
    const auto difference = [&](auto part) {
      return (8 * (part(at(step)) - part(at(-step))) - (part(at(2 * step)) - part(at(-2 * step)))) / (12 * step);
    };
    EXPECT_NEAR(direct.gaussian, difference([](const Curvatures& c) { return c.gaussian; }), 1e-7 * size);
    EXPECT_NEAR(direct.mean, difference([](const Curvatures& c) { return c.mean; }), 1e-7 * mean_size);
  }
}

TEST(Curvature, ZeroGradientGivesZero) {
  EXPECT_EQ(curvatures(Vec3::Zero(), Mat3::Identity()).gaussian, 0);
  EXPECT_EQ(belyaev_curvatures(Vec3::Zero(), Mat3::Identity()).mean, 0);
  EXPECT_EQ(CurvatureChange(Vec3::Zero(), Mat3::Identity())(Vec3::UnitX(), Mat3::Identity()).gaussian, 0);
  EXPECT_EQ(BelyaevCurvatureChange(Vec3::Zero(), Mat3::Identity())(Vec3::UnitX(), Mat3::Identity()).mean, 0);
}

}  // namespace
}  // namespace flowskin::tracking::curvature_test
