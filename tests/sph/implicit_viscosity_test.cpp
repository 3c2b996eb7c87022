// The implicit viscosity: against the explicit force as an operator, against theory, and what it must keep.
#include "sph/viscosity/implicit_viscosity.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <Eigen/Dense>

#include "sph/neighbors/hilbert_order.h"
#include "sph/setup/automatic_values.h"
#include "tests/sph/test_meshes.h"

namespace flowskin::sph::implicit_viscosity_test {
namespace {

Vec3 angular_momentum(const FluidState& state) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < state.ids.size(); ++i) sum += state.positions[i].cross(state.velocities[i]);
  return sum;
}

// A shaken lattice of particles with random velocities, in a random cloud of wall particles.
struct Cloud {
  SolverSettings settings;
  PairCoefficients coefficients;
  std::vector<FluidPack> packs;
  std::vector<WallPack> walls;
  std::vector<float> viscosities;
  PointClusters clusters, wall_clusters;
  NeighborLists fluid_lists, wall_lists;
  std::vector<ParticleRates> rates;
  std::vector<float> wall_distances;
  std::vector<Vec3> velocities;

  Cloud(std::size_t count, std::size_t wall_count, double viscosity, bool variable) {
    settings.spacing = 0.1;
    settings.viscosity = viscosity;
    settings.speed_of_sound = 10;
    settings.gravity.setZero();
    settings.viscosity_tolerance = 1e-5;
    Random random(17);
    std::vector<Eigen::Vector3f> points(count), wall_points(wall_count);
    const auto edge = static_cast<std::size_t>(std::ceil(std::cbrt(static_cast<double>(count))));
    for (std::size_t k = 0; k < count; ++k) {
      const Eigen::Vector3d cell(double(k % edge), double(k / edge % edge), double(k / edge / edge));
      points[k] = (0.1 * (cell + 0.6 * random.vector())).cast<float>();
    }
    for (auto& p : wall_points) p = (0.6 * random.vector()).cast<float>();
    HilbertOrder curve;
    curve.compute(points, 0.1F);
    for (const std::uint32_t i : curve.order()) {
      packs.push_back({points[i].x(), points[i].y(), points[i].z(), 0, 0, 0, 0, 0});
      velocities.push_back(random.vector() - Vec3(0.5, 0.5, 0.5));
      if (variable) viscosities.push_back(static_cast<float>(viscosity * std::pow(100.0, random())));
    }
    for (std::size_t i = 0; i < count; ++i) points[i] = {packs[i].x, packs[i].y, packs[i].z};
    for (const auto& p : wall_points) walls.push_back({p.x(), p.y(), p.z(), 1, 0.7F, {}});
    clusters.assign(points, 0.3F);
    wall_clusters.assign(wall_points, 0.3F);
    fluid_lists.build(clusters, clusters, 0.2F);
    wall_lists.build(clusters, wall_clusters, 0.2F);
    rates.resize(count);
    wall_distances.resize(count);
    set_form(ViscosityForm::monaghan);
  }

  void set_form(ViscosityForm form) {
    settings.viscosity_form = form;
    coefficients = PairCoefficients(settings, make_wall_kernel(settings), !viscosities.empty());
  }

  // nu L v of the explicit force.
  std::vector<Vec3> explicit_acceleration(const std::vector<Vec3>& v) {
    for (std::size_t i = 0; i < v.size(); ++i) {
      packs[i].vx = static_cast<float>(v[i].x());
      packs[i].vy = static_cast<float>(v[i].y());
      packs[i].vz = static_cast<float>(v[i].z());
    }
    PairData data{packs, &clusters, &fluid_lists, walls, &wall_lists, 0, rates, wall_distances, {}};
    data.viscosities = viscosities;
    compute_forces(coefficients, settings, data);
    std::vector<Vec3> result;
    for (const ParticleRates& rate : rates) result.emplace_back(rate.ax, rate.ay, rate.az);
    return result;
  }

  ImplicitViscosity::Result solve(double dt, std::vector<Vec3>& v, const std::vector<std::uint8_t>& fixed = {}) {
    rates.assign(v.size(), {});
    ImplicitViscosity implicit;
    return implicit.solve(coefficients, settings,
                          {packs, &clusters, &fluid_lists, walls, &wall_lists, viscosities, rates, fixed, dt, v});
  }
};

// I - dt nu L as a dense matrix, a column from each unit velocity.
Eigen::MatrixXd dense_matrix(Cloud& cloud, double dt) {
  const std::size_t count = cloud.velocities.size();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(3 * Eigen::Index(count), 3 * Eigen::Index(count));
  for (Eigen::Index column = 0; column < matrix.cols(); ++column) {
    std::vector<Vec3> unit(count, Vec3::Zero());
    unit[static_cast<std::size_t>(column / 3)][column % 3] = 1;
    const std::vector<Vec3> image = cloud.explicit_acceleration(unit);
    for (std::size_t i = 0; i < count; ++i) matrix.block<3, 1>(3 * Eigen::Index(i), column) -= dt * image[i];
  }
  return matrix;
}

// (I - dt nu L) v = v* against a direct solution with the explicit force as L: both forms, walls, one viscosity or
// many.
TEST(ImplicitViscosity, SolvesWithTheOperatorOfTheExplicitForce) {
  for (const auto form : {ViscosityForm::monaghan, ViscosityForm::morris}) {
    for (const bool variable : {false, true}) {
      if (variable && form == ViscosityForm::morris) continue;  // not offered
      Cloud cloud(100, 30, 0.02, variable);
      cloud.set_form(form);
      const double dt = 0.3;
      std::vector<Vec3> v = cloud.velocities;
      const ImplicitViscosity::Result result = cloud.solve(dt, v);
      ASSERT_TRUE(result.converged);
      EXPECT_GT(result.iterations, 3);

      const Eigen::MatrixXd matrix = dense_matrix(cloud, dt);
      EXPECT_LT((matrix - matrix.transpose()).norm(), 1e-5 * matrix.norm());
      const Eigen::VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues();
      EXPECT_GT(eigenvalues.minCoeff(), 1 - 1e-4);
      EXPECT_GT(eigenvalues.maxCoeff(), 5);
      const Eigen::Map<const Eigen::VectorXd> start(cloud.velocities[0].data(), matrix.rows());
      const Eigen::VectorXd exact = matrix.ldlt().solve(start);
      const Eigen::Map<const Eigen::VectorXd> found(v[0].data(), matrix.rows());
      EXPECT_GT((exact - start).norm(), 0.2 * start.norm());
      EXPECT_LT((found - exact).norm(), 1e-4 * (exact - start).norm());
    }
  }
}

TEST(ImplicitViscosity, KeepsMomentaHoweverRoughTheTolerance) {
  for (const bool variable : {false, true}) {
    Cloud cloud(400, 0, 0.05, variable);
    cloud.settings.viscosity_tolerance = 0.1;
    std::vector<Vec3> v = cloud.velocities;
    ASSERT_TRUE(cloud.solve(0.1, v).converged);
    Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
    double scale = 0, change = 0;
    for (std::size_t i = 0; i < v.size(); ++i) {
      const Vec3 x(cloud.packs[i].x, cloud.packs[i].y, cloud.packs[i].z), d = v[i] - cloud.velocities[i];
      linear += d;
      angular += x.cross(d);
      scale += cloud.velocities[i].norm();
      change += d.norm();
    }
    EXPECT_GT(change, 0.2 * scale);
    EXPECT_LT(linear.norm(), 1e-6 * scale);
    EXPECT_LT(angular.norm(), 1e-6 * scale);
  }
}

TEST(ImplicitViscosity, FixedParticlesKeepTheirVelocityAndOthersFollow) {
  Cloud cloud(300, 0, 1, false);
  std::vector<std::uint8_t> fixed(300, 1);
  fixed[100] = 0;
  for (Vec3& v : cloud.velocities) v = {1, 2, 3};
  cloud.velocities[100] = {0, 0, 0};
  std::vector<Vec3> v = cloud.velocities;
  ASSERT_TRUE(cloud.solve(10, v, fixed).converged);
  for (std::size_t i = 0; i < v.size(); ++i) {
    EXPECT_LT((v[i] - Vec3(1, 2, 3)).norm(), i == 100 ? 0.05 : 1e-12);
  }
}

TEST(ImplicitViscosity, SaysWhatToDoWhereItDoesNotConverge) {
  SimulationSetup setup = block_setup(0.05, {0, 0.1, 0}, {0.4, 0.5, 0.4});
  setup.bodies[0].angular_velocity = {3, 1, 0};
  setup.settings.viscosity = 10;
  setup.settings.viscosity_solver = ViscositySolver::implicit;
  setup.settings.viscosity_max_iterations = 1;
  setup.boundaries.push_back({sheet(0.5, 0.08), 0});
  Solver solver(setup);
  try {
    solver.advance_to(0.1);
    FAIL() << "one iteration should not be enough";
  } catch (const BlowUpError& error) {
    EXPECT_NE(std::string(error.what()).find("raise viscosity_tolerance or viscosity_max_iterations"),
              std::string::npos);
  }
  for (const Vec3& v : solver.state().velocities) EXPECT_TRUE(v.allFinite());
}

TEST(ImplicitViscosity, IsChosenWhereTheViscousLimitIsAQuarterOfTheAcousticOne) {
  for (const double factor : {0.9, 1.1}) {
    SimulationSetup setup = block_setup(0.05, {0, 0, 0}, {0.2, 0.2, 0.2});
    setup.settings.max_speed = 2;
    // Acoustic: 0.4 h / 20 m/s; viscous: 0.0625 h^2 / nu, with h = 0.05 m.
    const double acoustic = 0.4 * 0.05 / 20;
    setup.settings.viscosity = factor * 4 * 0.0625 * 0.05 * 0.05 / acoustic;
    const Solver solver(setup);
    EXPECT_EQ(solver.settings().viscosity_solver,
              factor > 1 ? ViscositySolver::implicit : ViscositySolver::explicit_steps);
  }
}

// A sine of shear in a block: both solvers alike within 2 %, the implicit one with steps twice as long.
TEST(ImplicitViscosity, ShearWaveDecaysAsExplicit) {
  double rates[2];
  const double spacing = 0.02, nu = 0.01, k = 2 * M_PI / 0.4;
  for (const bool implicit : {false, true}) {
    SimulationSetup setup = block_setup(spacing, {0, 0, 0}, {0.12, 0.8, 0.12});
    setup.bodies.clear();
    setup.settings.gravity.setZero();
    setup.settings.viscosity = nu;
    setup.settings.speed_of_sound = 1.5;
    setup.settings.viscosity_solver = implicit ? ViscositySolver::implicit : ViscositySolver::explicit_steps;
    for (int layer = 0; layer < 40; ++layer) {
      FluidBody body;
      body.block = {{0, layer * spacing, 0}, {0.12, (layer + 1) * spacing, 0.12}};
      body.velocity = {0.05 * std::sin(k * (layer + 0.5) * spacing), 0, 0};
      setup.bodies.push_back(body);
    }
    Solver solver(setup);
    solver.advance_to(0.06);
    const FluidState state = solver.state();
    double amplitude = 0, weight = 0;
    for (std::size_t i = 0; i < state.ids.size(); ++i) {
      const Vec3& p = state.positions[i];
      amplitude += state.velocities[i].x() * std::sin(k * p.y());
      weight += std::sin(k * p.y()) * std::sin(k * p.y());
    }
    rates[implicit] = -std::log(amplitude / weight / 0.05) / 0.06;
  }
  EXPECT_NEAR(rates[0], rates[1], 0.02 * rates[0]);
  EXPECT_GT(rates[1], 0.5 * nu * k * k);  // the open sides slow the decay
}

SimulationSetup heap(double viscosity, ViscositySolver solver) {
  SimulationSetup setup = block_setup(0.05, {-0.2, 0, -0.2}, {0.2, 0.4, 0.2});
  setup.settings.viscosity = viscosity;
  setup.settings.viscosity_solver = solver;
  setup.boundaries.push_back({sheet(0.8, 0), 0});
  return setup;
}

double mean_height(const FluidState& state) {
  double sum = 0;
  for (const Vec3& p : state.positions) sum += p.y();
  return sum / static_cast<double>(state.positions.size());
}

// A block that sinks on a no-slip plane: how far it has sunk agrees within 2 %.
TEST(ImplicitViscosity, SinkingHeapAgreesWithExplicit) {
  Solver implicit(heap(0.5, ViscositySolver::implicit)), explicit_steps(heap(0.5, ViscositySolver::explicit_steps));
  const double before = mean_height(implicit.state());
  implicit.advance_to(0.2);
  explicit_steps.advance_to(0.2);
  const double sunk[2] = {before - mean_height(implicit.state()), before - mean_height(explicit_steps.state())};
  EXPECT_GT(sunk[1], 0.01);
  EXPECT_NEAR(sunk[0], sunk[1], 0.02 * sunk[1]);
}

// At 10 m^2/s a heap creeps: it must not explode, nor go through the floor, nor fall freely within the steps.
TEST(ImplicitViscosity, HeapOfTenSquareMetresASecondOnlyCreeps) {
  Solver solver(heap(10, ViscositySolver::automatic));
  EXPECT_EQ(solver.settings().viscosity_solver, ViscositySolver::implicit);
  const double before = mean_height(solver.state());
  solver.advance_to(0.3);
  const FluidState state = solver.state();
  // Velocities scale as g H^2 / nu; at 0.5 m^2/s, twenty times thinner, it sinks at about 0.14 m/s.
  EXPECT_LT(solver.energy().kinetic, 0.5 * 64 * 0.02 * 0.02);
  EXPECT_NEAR(mean_height(state), before, 0.004);
  EXPECT_EQ(solver.statistics().wall_crossings, 0U);
  for (std::size_t i = 0; i < state.ids.size(); ++i) {
    EXPECT_GT(state.positions[i].y(), 0.015);
    EXPECT_LT(state.densities[i], 1020);
  }
}

TEST(ImplicitViscosity, ViscousBallSpinsOnInFreeFlight) {
  SimulationSetup setup;
  setup.settings.spacing = 0.06;
  setup.settings.viscosity = 10;
  FluidBody ball;
  ball.shape = FluidBody::Shape::ball;
  ball.radius = 0.25;
  ball.angular_velocity = {0, 2, 0.5};
  setup.bodies.push_back(ball);
  Solver solver(setup);
  const Vec3 before = angular_momentum(solver.state());
  solver.advance_to(0.2);
  const FluidState state = solver.state();
  Vec3 center = Vec3::Zero(), velocity = Vec3::Zero();
  const auto count = static_cast<double>(state.ids.size());
  for (std::size_t i = 0; i < state.ids.size(); ++i) {
    center += state.positions[i] / count;
    velocity += state.velocities[i] / count;
  }
  EXPECT_LT((velocity - 0.2 * setup.settings.gravity).norm(), 1e-5);
  Vec3 spin = Vec3::Zero();
  for (std::size_t i = 0; i < state.ids.size(); ++i) spin += (state.positions[i] - center).cross(state.velocities[i]);
  EXPECT_LT((spin - before).norm(), 1e-4 * before.norm());
}

TEST(ImplicitViscosity, SameBytesAtAnyNumberOfThreads) {
  const int threads = omp_get_max_threads();
  std::vector<FluidState> states;
  for (const int count : {1, 3}) {
    omp_set_num_threads(count);
    SimulationSetup setup = heap(5, ViscositySolver::implicit);
    setup.settings.spacing = 0.025;
    Solver solver(setup);
    EXPECT_GT(solver.particle_count(), 3000U);
    for (int step = 0; step < 2; ++step) solver.step();
    states.push_back(solver.state());
  }
  omp_set_num_threads(threads);
  EXPECT_EQ(states[0].velocities, states[1].velocities);
  EXPECT_EQ(states[0].positions, states[1].positions);
}

}  // namespace
}  // namespace flowskin::sph::implicit_viscosity_test
