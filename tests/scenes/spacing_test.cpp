// The estimate of the spacing against bodies whose spacing is known by construction: volume over number of particles.
#include "scenes/sources/particle_spacing.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "common/outliers.h"

namespace flowskin::scenes {
namespace {

using sph::Vec3;
using Points = std::vector<Vec3>;

constexpr unsigned kSeed = 5;

/// A lattice of spacing 1, each particle displaced by up to `jitter` along each axis.
Points lattice(int nx, int ny, int nz, double jitter = 0) {
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> shift(-jitter, jitter);
  Points points;
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j)
      for (int k = 0; k < nz; ++k)
        points.emplace_back(Vec3(i, j, k) +
                            (jitter > 0 ? Vec3(shift(random), shift(random), shift(random)) : Vec3(0, 0, 0)));
  return points;
}

void expect_spacing(const Points& points, double tolerance, const std::string& what, double spacing = 1) {
  for (const double unit : {1.0, 1e-3}) {
    Points scaled;
    for (const Vec3& x : points) scaled.emplace_back(unit * x);
    EXPECT_NEAR(estimate_spacing(scaled).spacing / (unit * spacing), 1, tolerance) << what;
  }
}

TEST(Spacing, LatticesSmallAndThinAndSheared) {
  for (const int n : {2, 3, 4, 5, 6, 8, 10}) expect_spacing(lattice(n, n, n), 1e-9, fmt::format("cube {}", n));
  for (const int layers : {1, 2, 3, 4}) {
    expect_spacing(lattice(20, layers, 20), 1e-9, fmt::format("slab {}", layers));
    expect_spacing(lattice(5, layers, 7), 1e-9, fmt::format("small slab {}", layers));
    expect_spacing(lattice(20, layers, 20, 0.02), 0.05, fmt::format("slab {}, nearly even", layers));
  }
  Points ball;
  for (const Vec3& x : lattice(13, 13, 13))
    if ((x - Vec3(6, 6, 6)).norm() <= 4.2) ball.push_back(x);
  expect_spacing(ball, 1e-9, "ball");
  for (const double shear : {0.3, 0.5, 1.0, 1.7}) {
    Points sheared = lattice(10, 10, 10), bent = lattice(12, 6, 12, 0.1);
    for (Vec3& x : sheared) x.x() += shear * x.y();
    for (Vec3& x : bent) x.x() += shear * x.y() * x.y() / 6;
    expect_spacing(sheared, 1e-9, fmt::format("shear {}", shear));
    expect_spacing(bent, 0.1, fmt::format("bent {}", shear));
  }
  Points stretched = lattice(8, 8, 8);
  for (Vec3& x : stretched) x = Vec3(1.6 * x.x(), x.y() / 1.6, x.z());
  expect_spacing(stretched, 1e-9, "stretched");
}

TEST(Spacing, ParticlesInDisorder) {
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> share(0, 1);
  for (const int n : {512, 4096}) {
    const double edge = std::cbrt(n);
    Points uniform;
    for (int i = 0; i < n; ++i) uniform.emplace_back(edge * Vec3(share(random), share(random), share(random)));
    expect_spacing(uniform, 0.1, fmt::format("uniform {}", n));
  }
  Points seeded;  // eight a cell
  for (const Vec3& cell : lattice(6, 6, 6))
    for (int i = 0; i < 8; ++i) seeded.emplace_back(2 * (cell + Vec3(share(random), share(random), share(random))));
  expect_spacing(seeded, 0.1, "eight a cell");
  for (const double jitter : {0.1, 0.3, 0.5}) {
    expect_spacing(lattice(12, 12, 12, jitter), 0.1, fmt::format("jitter {}", jitter));
    for (const int layers : {3, 4})
      expect_spacing(lattice(25, layers, 25, jitter), 0.1, fmt::format("film {}", layers));
  }
  // A free surface with waves, and spray above it.
  Points wave;
  for (const Vec3& x : lattice(30, 12, 12, 0.3))
    if (x.y() < 6 + 4 * std::sin(0.4 * x.x())) wave.push_back(x);
  for (int i = 0; i < 60; ++i) wave.emplace_back(Vec3(30 * share(random), 15 + 30 * share(random), 12 * share(random)));
  expect_spacing(wave, 0.1, "wave with spray");
}

TEST(Spacing, CoincidentParticlesCountOnce) {
  Points twice = lattice(8, 8, 8);
  const Points once = twice;
  twice.insert(twice.end(), once.begin(), once.end());
  const SpacingEstimate estimate = estimate_spacing(twice);
  EXPECT_NEAR(estimate.spacing, 1, 1e-9);
  EXPECT_EQ(estimate.coincident, once.size());
  Points rounded = once;
  for (const Vec3& x : once) rounded.emplace_back(x * (1 + 1e-7) + Vec3(1e-7, 0, 0));
  EXPECT_NEAR(estimate_spacing(rounded).spacing, 1, 1e-6);
  Points corner = lattice(5, 5, 5);
  corner.resize(corner.size() + 300, Vec3(0, 0, 0));
  EXPECT_NEAR(estimate_spacing(corner).spacing, 1, 1e-9);
  EXPECT_EQ(estimate_spacing(Points(100, Vec3(1, 2, 3))).spacing, 0);
}

TEST(Spacing, PlanesAndLinesAreKnown) {
  EXPECT_EQ(estimate_spacing(lattice(20, 1, 20)).dimensions, 2);
  EXPECT_EQ(estimate_spacing(lattice(20, 1, 1)).dimensions, 1);
  EXPECT_EQ(estimate_spacing(lattice(20, 2, 20)).dimensions, 3);
  Points stray = lattice(6, 6, 6);
  stray.emplace_back(1e7, 3e6, 0);
  EXPECT_EQ(estimate_spacing(stray).dimensions, 3);
  EXPECT_NEAR(estimate_spacing(lattice(20, 1, 1)).spacing, 1, 1e-9);
}

TEST(Outliers, OneParticleThatFlewOffIsLeftOutAndASprayIsNot) {
  Points points = lattice(7, 7, 7);
  EXPECT_EQ(without_outliers(points, 10), points);
  points.emplace_back(1e7, 300, 0);
  EXPECT_EQ(without_outliers(points, 10), lattice(7, 7, 7));
  points.back() = Vec3(12, 3, 3);
  EXPECT_EQ(without_outliers(points, 10), points);
  Points two = lattice(10, 10, 10);  // two bodies far apart
  for (const Vec3& x : lattice(4, 4, 4)) two.emplace_back(x + Vec3(500, 0, 0));
  EXPECT_EQ(without_outliers(two, 10), two);
}

}  // namespace
}  // namespace flowskin::scenes
