// The solver as a whole: settings, steps, determinism, memory, errors.
#include "sph/solver.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>

#include "tests/sph/test_meshes.h"

namespace flowskin::sph::solver_test {
namespace {

// A block that collapses in a box, with a jet pouring in.
SimulationSetup busy_setup() {
  SimulationSetup setup = block_setup(0.04, {0, 0, 0}, {0.6, 0.8, 0.5});
  setup.settings.viscosity = 0.005;
  setup.boundaries.push_back(tank(closed_box({0, 0, 0}, {1.2, 1.5, 0.5}), 0.3));
  Emitter emitter;
  emitter.center = {0.8, 1.2, 0.25};
  emitter.radius = 0.12;
  emitter.speed = 1;
  emitter.stop = 0.3;
  setup.emitters.push_back(emitter);
  return setup;
}

void expect_same(const FluidState& a, const FluidState& b) {
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.ids, b.ids);
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.velocities, b.velocities);
  EXPECT_EQ(a.rest_positions, b.rest_positions);
  EXPECT_EQ(a.densities, b.densities);
}

TEST(Solver, SameBytesAtAnyNumberOfThreads) {
  const int threads = omp_get_max_threads();
  std::vector<FluidState> states;
  for (const int count : {1, 2}) {
    omp_set_num_threads(count);
    Solver solver(busy_setup());
    solver.advance_to(0.06);
    states.push_back(solver.state());
  }
  omp_set_num_threads(threads);
  expect_same(states[0], states[1]);
}

TEST(Solver, StateIsInOrderOfIds) {
  Solver solver(busy_setup());
  solver.advance_to(0.2);
  const FluidState state = solver.state();
  EXPECT_TRUE(std::is_sorted(state.ids.begin(), state.ids.end()));
  EXPECT_EQ(state.ids.size(), solver.particle_count());
  EXPECT_EQ(state.positions.size(), state.ids.size());
  EXPECT_GT(solver.statistics().emitted, 0U);
}

TEST(Solver, MemoryDoesNotGrow) {
  SimulationSetup setup = busy_setup();
  setup.emitters.clear();
  Solver solver(setup);
  solver.advance_to(0.3);
  const std::size_t before = solver.memory_bytes();
  const auto rebuilds = solver.statistics().list_rebuilds;
  for (int k = 0; k < 400; ++k) solver.step();
  EXPECT_GT(solver.statistics().list_rebuilds, rebuilds + 5);
  EXPECT_LT(static_cast<double>(solver.memory_bytes()), 1.1 * static_cast<double>(before));
}

TEST(Solver, ListsAreKeptBetweenRebuildsAndDoNotChangeTheResult) {
  // Another skin, other rebuilds: the same pairs, summed in another order.
  SimulationSetup setup = busy_setup();
  setup.emitters.clear();
  setup.settings.viscosity = 0.05;
  std::vector<FluidState> states;
  std::vector<std::uint64_t> rebuilds;
  for (const double skin : {0.1, 0.6}) {
    setup.settings.skin = skin;
    Solver solver(setup);
    solver.advance_to(0.05);
    states.push_back(solver.state());
    rebuilds.push_back(solver.statistics().list_rebuilds);
    EXPECT_LT(solver.statistics().list_rebuilds, solver.statistics().steps);
  }
  EXPECT_GT(rebuilds[0], rebuilds[1]);
  for (std::size_t i = 0; i < states[0].ids.size(); ++i) {
    EXPECT_LT((states[0].positions[i] - states[1].positions[i]).norm(), 1e-4 * 0.05);
  }
}

TEST(Solver, ReportsTheLimitsOfTheStep) {
  SimulationSetup setup = block_setup(0.1, {0, 0, 0}, {0.5, 0.5, 0.5});
  setup.settings.speed_of_sound = 20;
  setup.settings.viscosity_solver = ViscositySolver::explicit_steps;
  setup.settings.max_speed = 2;
  setup.settings.viscosity = 1e-3;
  Solver acoustic(setup);
  acoustic.step();
  TimeStepReport report = acoustic.statistics().last_step;
  EXPECT_EQ(report.limited_by, TimeStepLimit::acoustic);
  EXPECT_NEAR(report.acoustic, 0.4 * 0.1 / 20, 1e-6);
  EXPECT_NEAR(report.viscous, 0.5 * 0.125 * 0.01 / 1e-3, 1e-9);
  EXPECT_NEAR(report.force, 0.25 * std::sqrt(0.1 / 9.81), 1e-4);
  EXPECT_EQ(report.step, report.acoustic);
  EXPECT_EQ(acoustic.statistics().steps_limited_by_acoustic, 1U);

  setup.settings.viscosity = 10;
  Solver viscous(setup);
  viscous.step();
  EXPECT_EQ(viscous.statistics().last_step.limited_by, TimeStepLimit::viscous);
  setup.settings.viscosity = 0;
  setup.settings.gravity = {0, -2500, 0};
  Solver forced(setup);
  forced.step();
  EXPECT_EQ(forced.statistics().last_step.limited_by, TimeStepLimit::force);
  setup.settings.gravity.setZero();
  setup.settings.max_time_step = 1e-5;
  Solver set(setup);
  set.step();
  EXPECT_EQ(set.statistics().last_step.limited_by, TimeStepLimit::setting);
  EXPECT_EQ(set.step(1e-6), 1e-6);
  EXPECT_EQ(set.statistics().last_step.limited_by, TimeStepLimit::output);
}

TEST(Solver, ReachesTimesExactlyWithoutTinySteps) {
  SimulationSetup setup = block_setup(0.1, {0, 0, 0}, {0.5, 0.5, 0.5});
  setup.settings.speed_of_sound = 20;
  setup.settings.max_speed = 2;
  Solver solver(setup);
  const double longest = 0.4 * 0.1 / 20;
  solver.advance_to(10.05 * longest);
  EXPECT_EQ(solver.time(), 10.05 * longest);
  EXPECT_GT(solver.statistics().last_step.step, 0.45 * longest);
}

TEST(Solver, AutomaticSpeedsComeFromTheFall) {
  SimulationSetup setup = block_setup(0.05, {0, 1, 0}, {0.5, 1.5, 0.5});
  setup.boundaries.push_back({sheet(2, 0), 0});
  Solver solver(setup);
  const double wanted = std::sqrt(2 * 9.81 * 1.475);
  EXPECT_NEAR(solver.settings().max_speed, wanted, 1e-9);
  EXPECT_NEAR(solver.settings().speed_of_sound, 10 * wanted, 1e-9);
  EXPECT_GT(solver.settings().skin, 0);
}

TEST(Solver, ParticlesThatLeaveTheDomainAreRemovedAndCounted) {
  SimulationSetup setup = block_setup(0.1, {0, 0, 0}, {0.5, 0.5, 0.5});
  setup.settings.domain = {{-1, -0.3, -1}, {1, 1, 1}};
  Solver solver(setup);
  double t = 0;
  while (solver.particle_count() > 0 && t < 1) {
    t += 0.02;
    solver.advance_to(t);
    for (const Vec3& p : solver.state().positions) EXPECT_GE(p.y(), -0.3);
    EXPECT_EQ(solver.particle_count() + solver.statistics().left_domain, 125U);
  }
  EXPECT_EQ(solver.particle_count(), 0U);
  solver.advance_to(t + 0.1);  // nothing left: still fine
}

TEST(Solver, EmitterAloneStartsEmptyAndPours) {
  SimulationSetup setup;
  setup.settings.spacing = 0.02;
  setup.settings.viscosity = 0.01;
  Emitter emitter;
  emitter.center = {0, 0.5, 0};
  emitter.radius = 0.06;
  emitter.speed = 0.8;
  emitter.start = 0.05;
  setup.emitters.push_back(emitter);
  setup.boundaries.push_back({sheet(0.5, 0), 0});
  Solver solver(setup);
  EXPECT_EQ(solver.particle_count(), 0U);
  solver.advance_to(0.59);
  const double volume = static_cast<double>(solver.particle_count()) * 8e-6;
  EXPECT_NEAR(volume, M_PI * 0.0036 * 0.8 * 0.54, 0.06 * volume);
  EXPECT_EQ(solver.statistics().wall_crossings, 0U);
}

TEST(Solver, BlowUpSaysWhatHappenedAndKeepsTheState) {
  SimulationSetup setup = busy_setup();
  setup.emitters.clear();
  setup.settings.acoustic_cfl = 2;
  setup.settings.force_cfl = 2;
  Solver solver(setup);
  try {
    solver.advance_to(1);
    FAIL() << "steps five times too long must blow up";
  } catch (const BlowUpError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("t = "), std::string::npos) << message;
    EXPECT_NE(message.find("particle "), std::string::npos) << message;
    EXPECT_NE(message.find("acoustic_cfl"), std::string::npos) << message;
  }
  for (const Vec3& p : solver.state().positions) EXPECT_TRUE(p.allFinite());
  for (const Vec3& v : solver.state().velocities) EXPECT_TRUE(v.allFinite());
}

TEST(Solver, OtherKernelsAndOptionsRun) {
  for (const auto kernel : {KernelType::cubic_spline, KernelType::wendland_c2}) {
    for (const auto density : {DensityMethod::summation, DensityMethod::continuity}) {
      SimulationSetup setup = block_setup(0.05, {0, 0, 0}, {0.4, 0.4, 0.4});
      setup.settings.kernel = kernel;
      setup.settings.density_method = density;
      setup.settings.support_radius = 2.5;
      setup.settings.xsph = 0.3;
      setup.settings.viscosity = 0.01;
      setup.boundaries.push_back(tank(closed_box({0, 0, 0}, {0.8, 0.8, 0.4}), 0));
      Solver solver(setup);
      solver.advance_to(0.4);
      for (const Vec3& p : solver.state().positions) {
        EXPECT_TRUE((p.array() > 0).all() && p.x() < 0.8 && p.y() < 0.8 && p.z() < 0.4);
      }
    }
  }
}

TEST(Solver, ImpossibleSetupsAreErrorsThatNameTheSetting) {
  const auto message_of = [](const SimulationSetup& setup) -> std::string {
    try {
      const Solver solver(setup);
    } catch (const SettingsError& error) {
      return error.what();
    }
    return "no error";
  };
  const SimulationSetup good = block_setup(0.1, {0, 0, 0}, {0.5, 0.5, 0.5});
  EXPECT_EQ(message_of(good), "no error");
  SimulationSetup bad = good;
  bad.settings.spacing = -1;
  EXPECT_NE(message_of(bad).find("spacing"), std::string::npos);
  bad = good;
  bad.settings.viscosity = std::nan("");
  EXPECT_NE(message_of(bad).find("viscosity"), std::string::npos);
  bad = good;
  bad.settings.xsph = 2;
  EXPECT_NE(message_of(bad).find("xsph"), std::string::npos);
  bad = good;
  bad.bodies.clear();
  EXPECT_NE(message_of(bad).find("nothing to simulate"), std::string::npos);
  bad = good;
  bad.bodies[0].block.max = {0.01, 0.5, 0.5};
  EXPECT_NE(message_of(bad).find("fluid body 1"), std::string::npos);
  bad = good;
  bad.boundaries.push_back({sheet(1, 0), 3});
  EXPECT_NE(message_of(bad).find("slip"), std::string::npos);
  bad.boundaries[0].slip = 0;
  bad.boundaries[0].mesh.triangles[0][1] = 99;
  EXPECT_NE(message_of(bad).find("99"), std::string::npos);
}

}  // namespace
}  // namespace flowskin::sph::solver_test
