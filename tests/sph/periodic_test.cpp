// Periodic domains: lists with images, rest, momentum, and the choice of the box's place, which must not matter.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "sph/neighbors/hilbert_order.h"
#include "sph/neighbors/neighbor_lists.h"
#include "sph/walls/boundary_sampling.h"
#include "sph/walls/wall_guard.h"
#include "sph/walls/wall_kernel.h"
#include "tests/sph/test_meshes.h"

namespace flowskin::sph::periodic_test {
namespace {

using Points = std::vector<Eigen::Vector3f>;

Points points_in(const Eigen::Vector3f& period, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  Points points(count);
  for (auto& p : points) {
    const Eigen::Vector3f unit = random.vector().cast<float>() - Eigen::Vector3f::Constant(0.5F);
    // Not all the box, so that bounding boxes of the points and the periodic box differ.
    for (int a = 0; a < 3; ++a) p[a] = unit[a] * (period[a] > 0 ? 0.98F * period[a] : 1.0F);
  }
  HilbertOrder curve;
  curve.compute(points, 0.1F);
  Points sorted;
  for (const std::uint32_t i : curve.order()) sorted.push_back(points[i]);
  return sorted;
}

// Nearest distance over all images, by brute force.
float distance(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& period) {
  float nearest = 1e30F;
  for (int i = -1; i <= 1; ++i) {
    for (int j = -1; j <= 1; ++j) {
      for (int k = -1; k <= 1; ++k) {
        const Eigen::Vector3f shift = period.cwiseProduct(Eigen::Vector3i(i, j, k).cast<float>());
        nearest = std::min(nearest, (a - b + shift).norm());
      }
    }
  }
  return nearest;
}

void expect_right_lists(const Points& targets, const Points& sources, float radius, const Eigen::Vector3f& period) {
  PointClusters target_clusters, source_clusters;
  target_clusters.assign(targets, 0.3F);
  source_clusters.assign(sources, 0.3F);
  NeighborLists lists;
  lists.build(target_clusters, source_clusters, radius, period);
  for (std::size_t c = 0; c < target_clusters.size(); ++c) {
    const PointCluster& cluster = target_clusters[c];
    const auto entries = lists.of_cluster(c);
    const std::set<std::uint32_t> listed(entries.begin(), entries.end());
    EXPECT_TRUE(std::is_sorted(entries.begin(), entries.end()));
    EXPECT_EQ(listed.size(), entries.size());
    for (std::uint32_t s = 0; s < sources.size(); ++s) {
      float nearest = 1e30F;
      for (std::uint32_t k = 0; k < cluster.count; ++k) {
        nearest = std::min(nearest, distance(targets[cluster.first + k], sources[s], period));
      }
      const bool is_listed = listed.count(s) > 0;
      EXPECT_TRUE(is_listed || nearest >= radius) << "missed at " << nearest;
      EXPECT_TRUE(!is_listed || nearest <= 1.0001F * radius) << "too far at " << nearest;
    }
  }
}

TEST(Periodic, ListsAgreeWithBruteForceOverAllImages) {
  for (const Eigen::Vector3f& period : {Eigen::Vector3f(1, 1.2F, 0.9F), Eigen::Vector3f(0, 1, 0),
                                        Eigen::Vector3f(0.41F, 0, 1), Eigen::Vector3f(0.5F, 0.5F, 0.5F)}) {
    const Points points = points_in(period, 700, 11), sources = points_in(period, 300, 12);
    for (const float radius : {0.05F, 0.2F}) {
      expect_right_lists(points, points, radius, period);
      expect_right_lists(points, sources, radius, period);
    }
  }
}

TEST(Periodic, BoxWrapsAndCuts) {
  const PeriodicBox box({{-1, 0, 2}, {1, 0, 5}}, {true, false, true});
  EXPECT_EQ(box.wrap({1, 7, 8.5}), Vec3(-1, 7, 2.5));
  EXPECT_EQ(box.wrap({-1 - 1e-17, 0, 2}), Vec3(-1, 0, 2));
  const Vec3 below = box.wrap({-1 - 1e-16, 0, 2 - 1e-16});
  EXPECT_TRUE(below.x() < 1 && below.x() >= -1 && below.z() < 5);
  EXPECT_LT((box.shortest({1.9, 3, -1.6}) - Vec3(-0.1, 3, 1.4)).norm(), 1e-15);
  // The part of a large sheet inside the box, 2 m times 3 m.
  double area = 0;
  const TriangleMesh cut = box.clip(sheet(20, 0.5));
  for (const auto& t : cut.triangles) {
    const Vec3 &a = cut.positions[t[0]], &b = cut.positions[t[1]], &c = cut.positions[t[2]];
    area += 0.5 * (b - a).cross(c - a).y();
    for (const Vec3& p : {a, b, c}) EXPECT_TRUE(p.x() >= -1 && p.x() <= 1 && p.z() >= 2 && p.z() <= 5);
  }
  EXPECT_NEAR(area, 6, 1e-12);
}

TEST(Periodic, WallsAreUniformAcrossTheSeam) {
  // A sheet that is larger than the box, and one that ends exactly at it: the same samples, all with the same volume.
  const PeriodicBox box({{-0.5, 0, -0.4}, {0.5, 0, 0.4}}, {true, false, true});
  TriangleMesh exact;
  add_quad(exact, {-0.5, 0.1, -0.4}, {-0.5, 0.1, 0.4}, {0.5, 0.1, 0.4}, {0.5, 0.1, -0.4});
  for (const TriangleMesh& mesh : {box.clip(sheet(3, 0.1)), box.clip(exact)}) {
    const std::vector<Vec3> samples = sample_surface(mesh, 0.047, box);
    EXPECT_EQ(samples.size(), 21U * 17U);
    const std::vector<double> volumes = boundary_volumes(samples, KernelType::wendland_c2, 0.094, box);
    const auto [least, greatest] = std::minmax_element(volumes.begin(), volumes.end());
    EXPECT_NEAR(*greatest / *least, 1, 1e-9);
  }
}

SimulationSetup periodic_block(double spacing, int nx, int ny, int nz) {
  SimulationSetup setup = block_setup(spacing, {0, 0, 0}, spacing * Vec3(nx, ny, nz));
  setup.settings.gravity.setZero();
  setup.settings.domain = setup.bodies[0].block;
  setup.settings.periodic = {true, true, true};
  return setup;
}

TEST(Periodic, FullBoxIsUniformAndStaysAtRest) {
  for (const DensityMethod method : {DensityMethod::summation, DensityMethod::continuity}) {
    SimulationSetup setup = periodic_block(0.05, 12, 9, 4);
    setup.settings.density_method = method;
    setup.bodies[0].velocity = {0.3, 0, -0.1};
    Solver solver(setup);
    for (const double density : solver.state().densities) EXPECT_NEAR(density, 1000, 1e-3);
    const Vec3 momentum = solver.momentum();
    // Far enough to be wrapped several times.
    solver.advance_to(6);
    const FluidState state = solver.state();
    ASSERT_EQ(state.ids.size(), 12U * 9 * 4);
    const PeriodicBox box(setup.settings.domain, setup.settings.periodic);
    for (std::size_t i = 0; i < state.ids.size(); ++i) {
      const Vec3 wanted = state.rest_positions[i] + 6 * setup.bodies[0].velocity;
      EXPECT_LT(box.shortest(state.positions[i] - wanted).norm(), 1e-3 * 0.05);
      EXPECT_LT((state.velocities[i] - setup.bodies[0].velocity).norm(), 1e-4);
      EXPECT_NEAR(state.densities[i], 1000, 0.02);
      EXPECT_EQ(state.positions[i], box.wrap(state.positions[i]));
    }
    EXPECT_LT((solver.momentum() - momentum).norm(), 2e-6 * momentum.norm());
  }
}

// A flow without symmetry: a wavy velocity, free surfaces along y, a wall below.
SimulationSetup wavy_channel(const Vec3& shift) {
  SimulationSetup setup = block_setup(0.05, {0, 0, 0}, {0.6, 0.3, 0.4});
  setup.settings.viscosity = 0.01;
  setup.settings.max_speed = 2;
  setup.settings.domain = {{0, 0, 0}, {0.6, 0, 0.4}};
  setup.settings.periodic = {true, false, true};
  setup.bodies[0].velocity = {0.5, 0, 0.2};
  FluidBody drop;
  drop.shape = FluidBody::Shape::ball;
  drop.center = Vec3(0.25, 0.5, 0.1) + shift;
  drop.radius = 0.12;
  drop.velocity = {0, -1, 0.4};
  setup.bodies.push_back(drop);
  setup.boundaries.push_back({sheet(2, 0), 0.5});
  return setup;
}

TEST(Periodic, AShiftByHalfAPeriodChangesNothing) {
  // The block fills the box, the drop crosses one seam before the shift and two after it. The period along x holds an
  // even number of wall particles, so they are shifted onto each other.
  const Vec3 shift(0.3, 0, 0);
  Solver here(wavy_channel(Vec3::Zero())), there(wavy_channel(shift));
  here.advance_to(0.25);
  there.advance_to(0.25);
  const FluidState a = here.state(), b = there.state();
  ASSERT_EQ(a.ids.size(), b.ids.size());
  const PeriodicBox box(here.settings().domain, here.settings().periodic);
  // Particle i of the one run against the nearest of the other: the block's ids are shifted against each other.
  double worst = 0, moved = 0;
  for (std::size_t i = 0; i < a.ids.size(); ++i) {
    double nearest = 1e30;
    for (const Vec3& p : b.positions) nearest = std::min(nearest, box.shortest(p - shift - a.positions[i]).norm());
    worst = std::max(worst, nearest);
    moved = std::max(moved, box.shortest(a.positions[i] - a.rest_positions[i]).norm());
  }
  EXPECT_GT(moved, 0.1);
  EXPECT_LT(worst, 1e-4 * 0.05);
  EXPECT_NEAR(here.energy().kinetic, there.energy().kinetic, 1e-5 * here.energy().kinetic);
  EXPECT_EQ(here.statistics().wall_crossings, 0U);
  EXPECT_EQ(here.statistics().left_domain, 0U);
}

TEST(Periodic, MomentumIsKeptToRounding) {
  SimulationSetup setup = periodic_block(0.05, 10, 8, 8);
  setup.bodies[0].cuts.push_back({{0.1, 0.1, 0}, {0.3, 0.3, 0.4}});  // a hole that the flow closes
  setup.bodies[0].velocity = {1, 0.3, 0.2};
  setup.bodies[0].angular_velocity = {0.5, 1, 2};
  setup.settings.viscosity = 0.002;
  Solver solver(setup);
  const Vec3 before = solver.momentum();
  const double scale = 1000 * 0.000125 * static_cast<double>(solver.particle_count());
  solver.advance_to(0.3);
  EXPECT_LT((solver.momentum() - before).norm(), 2e-6 * scale);
  EXPECT_GT(solver.statistics().list_rebuilds, 3U);
}

TEST(Periodic, WallGuardSeesImages) {
  const PeriodicBox box({{0, 0, 0}, {1, 0, 0}}, {true, false, false});
  TriangleMesh wall;  // across x, close to the lower face
  add_quad(wall, {0.01, -1, -1}, {0.01, 1, -1}, {0.01, 1, 1}, {0.01, -1, 1});
  const WallGuard guard({wall}, 0.1, box);
  std::vector<std::uint32_t> found;
  const Vec3 from(0.99, 0, 0.1), to(1.03, 0, 0.1);
  guard.query(from, to, found);
  EXPECT_TRUE(guard.check(from, to, found).crossed);
  EXPECT_FALSE(guard.check(from, {1.005, 0, 0.1}, found).crossed);
}

TEST(Periodic, ImpossibleSettingsAreExplained) {
  const auto message = [](const SimulationSetup& setup) -> std::string {
    try {
      const Solver solver(setup);
    } catch (const SettingsError& error) {
      return error.what();
    }
    return "no error";
  };
  SimulationSetup setup = periodic_block(0.05, 12, 9, 3);
  EXPECT_NE(message(setup).find("along z"), std::string::npos) << message(setup);
  setup = periodic_block(0.05, 12, 9, 4);
  setup.settings.domain.max.x() += 0.02;
  setup.bodies[0].block.max.x() += 0.02;
  EXPECT_NE(message(setup).find("no whole number of spacings"), std::string::npos) << message(setup);
  setup.bodies[0].block.max.x() += 0.2;
  EXPECT_NE(message(setup).find("longer along x than the period"), std::string::npos) << message(setup);
}

}  // namespace
}  // namespace flowskin::sph::periodic_test
