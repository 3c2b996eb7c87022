// The measures of the paper's experiments against cases worked out by hand.
#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "common/errors.h"
#include "scenes/scene_file.h"
#include "tools/experiments/error_measures.h"
#include "tools/experiments/experiment.h"
#include "tools/experiments/material_motion.h"
#include "tools/experiments/result_table.h"
#include "tools/experiments/ride.h"
#include "tools/pipeline/tracker_bridge.h"

namespace flowskin::tools::experiments_test {
namespace {

scenes::Scene paper_scene(const std::string& name) {
  scenes::Scene scene = scenes::read_scene(FLOWSKIN_SOURCE_DIR "/scenes/paper/" + name + ".json");
  scene.tracking.edge_length *= 2;  // quick
  return scene;
}

TEST(ErrorMeasures, Distances) {
  const Distances found = distances({{1, 0, 0}, {0, 0, 5}, {2, 2, 2}}, {{0, 0, 0}, {0, 4, 2}, {2, 2, 2}});
  EXPECT_DOUBLE_EQ(found.mean, 2);
  EXPECT_DOUBLE_EQ(found.max, 5);
  EXPECT_EQ(distances({}, {}).max, 0);
  EXPECT_THROW(distances({{1, 0, 0}}, {}), std::invalid_argument);
}

TEST(ErrorMeasures, RelativeVelocityErrorIsZeroForTheTruthAndOneForStandingStill) {
  const std::vector<Vec3> truth{{1, 2, 3}, {-4, 0, 1}}, nothing(2, Vec3::Zero());
  EXPECT_EQ(relative_velocity_error(truth, truth), 0);
  EXPECT_DOUBLE_EQ(relative_velocity_error(nothing, truth), 1);
  EXPECT_DOUBLE_EQ(relative_velocity_error({{0, 0, 4}}, {{0, 3, 0}}), 5.0 / 3);
  EXPECT_EQ(relative_velocity_error(nothing, nothing), 0);
  EXPECT_EQ(relative_velocity_error(truth, nothing), std::numeric_limits<double>::infinity());
  EXPECT_THROW(relative_velocity_error(truth, {}), std::invalid_argument);
}

TEST(ErrorMeasures, EdgeStrain) {
  EXPECT_DOUBLE_EQ(edge_strain({2, 1, 0.5, 3}, {1, 1, 1, 3}), std::sqrt(1.25 / 4));
  EXPECT_EQ(edge_strain({}, {}), 0);
  EXPECT_THROW(edge_strain({1}, {0}), std::invalid_argument);
}

TEST(ErrorMeasures, ConvergenceOrderIgnoresErrorsAtTheFloor) {
  const std::vector<int> steps{10, 20, 40, 80, 160};
  std::vector<double> errors;
  for (const int n : steps) errors.push_back(std::max(3.0 * std::pow(n, -4), 1e-7));
  EXPECT_NEAR(convergence_order(steps, errors, 1e-6), 4, 1e-9);
  EXPECT_LT(convergence_order(steps, errors, 0), 3.8);  // the flat part counts
  EXPECT_TRUE(std::isnan(convergence_order(steps, errors, 1e-4)));
  EXPECT_TRUE(std::isnan(convergence_order({10, 10}, {0.1, 0.2}, 0)));
}

TEST(ResultTable, CsvReadsBackAndMarkdownIsShort) {
  ResultTable table;
  table.columns = {"name", "count", "value"};
  table.add({std::string("a"), 3, 1.0 / 3});
  EXPECT_EQ(table.csv(), "name,count,value\na,3,0.3333333333333333\n");
  EXPECT_EQ(table.markdown(), "| name | count | value |\n|---|---|---|\n| a | 3 | 0.333 |\n");
  EXPECT_THROW(table.add({1}), std::logic_error);
  table.add({std::string("a,b"), 3, 0.0});
  EXPECT_THROW(table.csv(), std::logic_error);
}

TEST(Verdicts, AllSomeNone) {
  EXPECT_EQ(verdict_of({true, true}), Verdict::confirmed);
  EXPECT_EQ(verdict_of({true, false}), Verdict::in_part);
  EXPECT_EQ(verdict_of({false, false}), Verdict::not_confirmed);
}

TEST(MaterialMotion, RotationWithAndWithoutSpin) {
  const MaterialMotion motion(paper_scene("circling_ball"));
  EXPECT_NEAR(motion.period(), 1, 1e-12);
  const Vec3 start(0.5, 0.2, 0.4);  // the particle is at (0.5, 0, 0)
  const Vec3 half = motion.position(start, 0.5), half_parallel = motion.position(start, 0.5, Truth::unspinning);
  EXPECT_LT((half - Vec3(-0.5, 0.2, -0.4)).norm(), 1e-12);
  EXPECT_LT((half_parallel - Vec3(-0.5, 0.2, 0.4)).norm(), 1e-12);
  // Velocities are the derivatives of the paths.
  constexpr double h = 1e-6;
  for (const Truth truth : {Truth::motion, Truth::unspinning}) {
    const Vec3 difference = (motion.position(start, 0.3 + h, truth) - motion.position(start, 0.3 - h, truth)) / (2 * h);
    EXPECT_LT((motion.velocity(motion.position(start, 0.3, truth), 0.3, truth) - difference).norm(), 1e-7);
  }
}

TEST(MaterialMotion, RefusesASimulation) { EXPECT_THROW(MaterialMotion(paper_scene("stairs")), InputError); }

TEST(Ride, SettingsAreThoseOfTheScene) {
  const RideSettings settings = ride_settings(paper_scene("ring_weak"));
  EXPECT_EQ(settings.steps_per_period, 240);
  EXPECT_EQ(settings.periods, 3);
  EXPECT_EQ(settings.fairing_iterations, 10);
  EXPECT_EQ(settings.integrator, tracking::Integrator::rk4);
}

TEST(Ride, TheTotalVelocityIsExactInATranslationAndTheNormalOneIsNot) {
  const scenes::Scene scene = paper_scene("translation");
  const tracking::SurfaceMesh start = start_mesh(scene);
  const auto rides = take_rides(
      scene, start, {{"normal", tracking::Integrator::rk4, 20, 1, 0}, {"total", tracking::Integrator::rk4, 20, 1, 0}});
  EXPECT_GT(rides[0].last().errors.end.mean, 0.1);
  EXPECT_GT(rides[0].last().strain, 0.1);
  EXPECT_LT(rides[1].last().errors.end.max, 1e-9);
  EXPECT_LT(rides[1].last().strain, 1e-9);
  // It ends elsewhere than it began: the return error sees the whole way, 1.5 sigma.
  EXPECT_NEAR(rides[1].last().errors.back.mean, 1.5, 1e-9);
}

TEST(Ride, ABallThatCirclesInParallelComesBackButIsWrongAboutSpin) {
  const scenes::Scene scene = paper_scene("circling_ball");
  const Ride ride = take_ride(scene, start_mesh(scene), {"total", tracking::Integrator::rk4, 40, 1, 0});
  EXPECT_LT(ride.last().errors.back.max, 1e-6);
  EXPECT_LT(ride.last().unspinning.path, 1e-6);
  EXPECT_LT(ride.last().unspinning.velocity_error, 1e-9);
  EXPECT_GT(ride.last().errors.path, 0.3);
  EXPECT_GT(ride.last().errors.velocity_error, 0.5);
}

TEST(Ride, SameResultsAtAnyNumberOfThreads) {
  const scenes::Scene scene = paper_scene("ring_weak");
  const tracking::SurfaceMesh start = start_mesh(scene);
  const std::vector<RideSettings> settings{{"curvature", tracking::Integrator::rk2, 10, 1, 3},
                                           {"total", tracking::Integrator::rk2, 10, 1, 3},
                                           {"normal", tracking::Integrator::euler, 10, 1, 0}};
  const int before = omp_get_max_threads();
  omp_set_num_threads(1);
  const auto alone = take_rides(scene, start, settings);
  omp_set_num_threads(3);
  const auto together = take_rides(scene, start, settings);
  omp_set_num_threads(before);
  for (std::size_t i = 0; i < settings.size(); ++i)
    EXPECT_EQ(alone[i].last().positions, together[i].last().positions) << settings[i].velocity;
}

TEST(Ride, AnUnknownMethodIsAnError) {
  const scenes::Scene scene = paper_scene("translation");
  EXPECT_THROW(take_rides(scene, start_mesh(scene), {{"wishful", tracking::Integrator::rk4, 10, 1, 0}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace flowskin::tools::experiments_test
