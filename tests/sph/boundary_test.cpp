// Sampling of walls, their volumes, and the guard against passing them.
#include <gtest/gtest.h>

#include <algorithm>

#include "sph/forces/kernels.h"
#include "sph/walls/boundary_sampling.h"
#include "sph/walls/wall_guard.h"
#include "sph/walls/wall_kernel.h"
#include "tests/sph/test_meshes.h"

namespace flowskin::sph::boundary_test {
namespace {

double nearest_distance(const std::vector<Vec3>& samples, const Vec3& p, std::size_t skip = ~std::size_t{0}) {
  double nearest = 1e30;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (k != skip) nearest = std::min(nearest, (samples[k] - p).norm());
  }
  return nearest;
}

Vec3 random_point_on(const TriangleMesh& mesh, Random& random) {
  const auto& t = mesh.triangles[static_cast<std::size_t>(random() * static_cast<double>(mesh.triangles.size()))];
  double u = random(), v = random();
  if (u + v > 1) u = 1 - u, v = 1 - v;
  return mesh.positions[t[0]] + u * (mesh.positions[t[1]] - mesh.positions[t[0]]) +
         v * (mesh.positions[t[2]] - mesh.positions[t[0]]);
}

class SamplingTest : public testing::TestWithParam<int> {
 protected:
  static TriangleMesh mesh() {
    switch (GetParam()) {
      case 0:
        return sheet(0.5, 0.2);
      case 1:
        return closed_box({-0.3, 0, -0.2}, {0.31, 0.47, 0.23});
      case 2:
        return sphere(Vec3::Zero(), 0.4, 40);  // triangles smaller than the spacing
      default:
        return sphere(Vec3::Zero(), 0.4, 4);  // greater than the spacing
    }
  }
};

TEST_P(SamplingTest, CoversTheSurfaceWithoutDuplicates) {
  const double spacing = 0.05;
  const TriangleMesh surface = mesh();
  const std::vector<Vec3> samples = sample_surface(surface, spacing);
  Random random(7);
  for (int k = 0; k < 500; ++k) {
    EXPECT_LT(nearest_distance(samples, random_point_on(surface, random)), coverage_radius * spacing);
  }
  for (const Vec3& vertex : surface.positions) EXPECT_LT(nearest_distance(samples, vertex), coverage_radius * spacing);
  for (std::size_t k = 0; k < samples.size(); ++k) EXPECT_GE(nearest_distance(samples, samples[k], k), 0.499 * spacing);
}

TEST_P(SamplingTest, DensityOfSamplesIsThatOfTheSpacing) {
  const double spacing = 0.05;
  const TriangleMesh surface = mesh();
  double area = 0;
  for (const auto& t : surface.triangles) {
    const Vec3 &a = surface.positions[t[0]], &b = surface.positions[t[1]], &c = surface.positions[t[2]];
    area += 0.5 * (b - a).cross(c - a).norm();
  }
  const double wanted = area / (spacing * spacing);
  const auto count = static_cast<double>(sample_surface(surface, spacing).size());
  EXPECT_GT(count, 0.85 * wanted);
  EXPECT_LT(count, 1.5 * wanted);
}

TEST_P(SamplingTest, SameMeshSameSamples) { EXPECT_EQ(sample_surface(mesh(), 0.04), sample_surface(mesh(), 0.04)); }

INSTANTIATE_TEST_SUITE_P(Meshes, SamplingTest, testing::Range(0, 4));

TEST(BoundaryVolumes, PlaneMatchesTheory) {
  // For a plane sampled with one particle per area A, sum W = (integral of W over the plane) / A; for the Wendland
  // kernel that integral is 3 / (2 R).
  const double spacing = 0.02, support = 0.08;
  const std::vector<Vec3> samples = sample_surface(sheet(0.4, 0), spacing);
  const std::vector<double> volumes = boundary_volumes(samples, KernelType::wendland_c2, support);
  int inner = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (std::max(std::abs(samples[k].x()), std::abs(samples[k].z())) > 0.25) continue;
    ++inner;
    EXPECT_NEAR(volumes[k], spacing * spacing * support / 1.5, 0.03 * spacing * spacing * support);
  }
  EXPECT_GT(inner, 400);
}

TEST(BoundaryVolumes, MoreParticlesAtOnePlaceShareTheVolume) {
  const std::vector<double> one = boundary_volumes({Vec3::Zero()}, KernelType::cubic_spline, 0.1);
  const std::vector<double> two = boundary_volumes({Vec3::Zero(), Vec3::Zero()}, KernelType::cubic_spline, 0.1);
  EXPECT_NEAR(two[0], 0.5 * one[0], 1e-12);
}

// A lattice half a spacing above a plane: what it lacks of a half space, the wall gives, in density and in push.
TEST(WallKernel, LatticeAboveAPlaneIsInEquilibriumWithIt) {
  for (const double support_radius : {2.0, 2.5}) {
    SolverSettings settings;
    settings.spacing = 0.02;
    settings.support_radius = support_radius;
    const double support = 0.02 * support_radius, kernel_sum = lattice_kernel_sum(settings);
    const WallKernel wall = make_wall_kernel(settings);
    const std::vector<Vec3> samples = sample_surface(sheet(0.3, 0), wall.sample_spacing);
    const std::vector<double> volumes = boundary_volumes(samples, settings.kernel, wall.support);
    // The stress of a lattice of equal pressure through a plane between its layers, in units of the pressure, by
    // summing all pairs across the plane; each particle has the area of a spacing squared.
    double missing = 0, stress = 0;
    for (int i = -4; i <= 4; ++i) {
      for (int j = -4; j < 0; ++j) {
        for (int k = -4; k <= 4; ++k) {
          const double r = 0.02 * std::hypot(i, j, k);
          missing += 8e-6 * kernel_value(settings.kernel, r, support) / kernel_sum;
          // A pair j layers apart crosses the plane from j places.
          stress += -j * 2 * 8e-6 * -WendlandC2::derivative(r, support) * (-j * 0.02) / r * 0.02 / kernel_sum;
        }
      }
    }
    EXPECT_NEAR(stress * lattice_pressure_factor(settings), 1, 1e-6);
    for (const Vec3& p : {Vec3(0, 0.01, 0), Vec3(0.003, 0.01, 0.007)}) {
      double given = 0, push = 0;
      for (std::size_t b = 0; b < samples.size(); ++b) {
        const Vec3 d = p - samples[b];
        const double volume = wall.volume_factor * volumes[b];
        given += volume * kernel_value(settings.kernel, d.norm(), wall.support);
        push -= volume * WendlandC2::derivative(d.norm(), wall.support) * d.y() / d.norm() * 0.02;
      }
      EXPECT_NEAR(given, missing, 0.03 * missing);
      EXPECT_NEAR(push, stress, 0.03 * stress);
    }
  }
}

std::vector<std::uint32_t> all_triangles(const WallGuard& guard) {
  std::vector<std::uint32_t> all;
  for (std::uint32_t t = 0; t < guard.triangle_count(); ++t) all.push_back(t);
  return all;
}

TEST(WallGuard, EveryPathOutOfAClosedMeshCrosses) {
  const TriangleMesh ball = sphere(Vec3::Zero(), 0.5, 12), box = closed_box({2, -0.5, -0.5}, {3, 0.5, 0.5});
  const WallGuard guard({ball, box}, 0.1);
  const auto all = all_triangles(guard);
  Random random(11);
  for (int k = 0; k < 5000; ++k) {
    const Vec3 direction = (random.vector() - Vec3::Constant(0.5)).normalized();
    const Vec3 inside = 0.3 * random() * direction;
    const WallGuard::Crossing crossing = guard.check(inside, inside + 0.9 * direction, all);
    EXPECT_TRUE(crossing.crossed);
    EXPECT_LT(crossing.normal.dot(direction), 0);
    EXPECT_FALSE(guard.check(inside, 0.4 * direction, all).crossed);
  }
  // Through edges and corners, where triangles meet.
  for (const Vec3& corner : box.positions) {
    const Vec3 center(2.5, 0, 0);
    EXPECT_TRUE(guard.check(center, center + 1.2 * (corner - center), all).crossed);
  }
  for (const auto& t : box.triangles) {
    const Vec3 center(2.5, 0, 0), edge = 0.5 * (box.positions[t[0]] + box.positions[t[1]]);
    EXPECT_TRUE(guard.check(center, center + 1.3 * (edge - center), all).crossed);
  }
}

TEST(WallGuard, GridFindsEveryTriangleNearby) {
  const TriangleMesh ball = sphere(Vec3(3, 1, -2), 0.5, 10);
  const WallGuard guard({ball}, 0.13);
  const auto all = all_triangles(guard);
  Random random(12);
  std::vector<std::uint32_t> found;
  for (int k = 0; k < 2000; ++k) {
    const Vec3 a = Vec3(3, 1, -2) + 1.4 * (random.vector() - Vec3::Constant(0.5));
    const Vec3 b = a + 0.2 * (random.vector() - Vec3::Constant(0.5));
    guard.query(a.cwiseMin(b), a.cwiseMax(b), found);
    EXPECT_EQ(guard.check(a, b, found).crossed, guard.check(a, b, all).crossed);
  }
}

}  // namespace
}  // namespace flowskin::sph::boundary_test
