// The solver behind the interface of all sources.
#include "scenes/sources/simulation_source.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "scene_file_helpers.h"
#include "scenes/sources/make_source.h"

namespace flowskin::scenes::simulation_source_test {
namespace {

Scene falling_ball() {
  return parse(R"({"particles": {"spacing": 0.05}, "fluid": {"viscosity": 0.01},
    "bodies": [{"shape": "ball", "center": [0, 1, 0], "radius": 0.2, "velocity": [0.5, 0, 0]}]})");
}

TEST(SimulationSource, AFreeBodyFallsAsItMust) {
  const auto source = make_source(falling_ball());
  const ParticleState start = source->state();
  EXPECT_EQ(start.time, 0);
  EXPECT_NEAR(static_cast<double>(start.ids.size()), 4.0 / 3 * std::numbers::pi * 64, 0.15 * 268);
  source->advance_to(0.1);
  const ParticleState& state = source->state();
  EXPECT_EQ(state.time, 0.1);
  ASSERT_EQ(state.ids, start.ids);
  EXPECT_TRUE(std::is_sorted(state.ids.begin(), state.ids.end()));
  Vec3 before = Vec3::Zero(), after = Vec3::Zero();
  for (std::size_t i = 0; i < start.ids.size(); ++i) {
    before += start.positions[i] / static_cast<double>(start.ids.size());
    after += state.positions[i] / static_cast<double>(start.ids.size());
    EXPECT_EQ(state.rest_positions[i], start.positions[i]);
  }
  // The centre of mass: x0 + v t + g t^2 / 2; symplectic Euler is off by at most g t dt / 2.
  EXPECT_NEAR(after.x() - before.x(), 0.05, 1e-6);
  EXPECT_NEAR(after.y() - before.y(), -0.5 * 9.81 * 0.01, 2e-3);
  EXPECT_EQ(source->spacing(), 0.05);
}

TEST(SimulationSource, TellsAboutItself) {
  const auto source = make_source(falling_ball());
  source->advance_to(0.05);
  const SourceStatistics statistics = source->statistics();
  EXPECT_GT(statistics.steps, 0u);
  EXPECT_GT(statistics.kinetic_energy, 0);
  EXPECT_GT(statistics.potential_energy, 0);
  EXPECT_GT(statistics.last_time_step, 0);
  EXPECT_LE(statistics.mean_density_error, statistics.max_density_error);
  EXPECT_EQ(statistics.left_domain, 0u);
  EXPECT_NE(statistics.summary.find("speed of sound"), std::string::npos);
  EXPECT_FALSE(source->ends_before(1000));
}

TEST(SimulationSource, TimeOnlyGoesForward) {
  const auto source = make_source(falling_ball());
  source->advance_to(0.01);
  source->advance_to(0.01);
  EXPECT_THROW(source->advance_to(0.005), std::invalid_argument);
}

TEST(SimulationSource, StairsHoldTheParticlesTheyPromise) {
  const auto particles = [](const char* name) {
    const Scene scene = read_scene(source_folder() / "scenes" / name);
    return make_source(scene)->state().ids.size();
  };
  EXPECT_NEAR(static_cast<double>(particles("stairs.json")), 20000, 1000);
  EXPECT_LT(particles("stairs_preview.json"), 2500u);
  EXPECT_GT(particles("stairs_preview.json"), 1500u);
}

TEST(SimulationSource, ImpossibleScenesAreErrors) {
  Scene scene = falling_ball();
  scene.particles.spacing = 5;
  EXPECT_THROW(make_source(scene), sph::SettingsError);
}

}  // namespace
}  // namespace flowskin::scenes::simulation_source_test
