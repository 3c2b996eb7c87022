// Particles that keep their id, but are taken out in one place and put in at another.
#include "tracking/advection/jumps.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/tracking/mesh_test_shapes.h"
#include "tracking/tracker.h"

namespace flowskin::tracking::jumps_test {
namespace {

constexpr double kFrame = 1.0 / 30;
constexpr int kLayers = 20;

// A round stream along x whose particles are half a spacing further in each state; those at its end start again.
Particles stream(double frame) {
  Particles particles;
  particles.time = frame * kFrame;
  for (int layer = 0; layer < kLayers; ++layer) {
    for (int j = -3; j <= 3; ++j) {
      for (int k = -3; k <= 3; ++k) {
        if (j * j + k * k > 10) continue;
        particles.ids.push_back(particles.ids.size());
        particles.positions.emplace_back(std::fmod(layer + 0.5 * frame, kLayers), j, k);
        particles.velocities.emplace_back(0.5 / kFrame, 0, 0);
      }
    }
  }
  particles.rest_positions = particles.positions;
  return particles;
}

std::vector<Sighting> sightings(const Particles& from, const Particles& to, bool with_velocities) {
  std::vector<Sighting> found;
  for (std::size_t i = 0; i < from.ids.size(); ++i) {
    found.push_back({to.positions[i] - from.positions[i]});
    if (!with_velocities) continue;
    found.back().before = from.velocities[i];
    found.back().after = to.velocities[i];
  }
  return found;
}

TEST(Jumps, AreToldWithAndWithoutVelocitiesOverAnyGap) {
  for (const bool with_velocities : {true, false}) {
    for (const double later : {1.0, 2.5, 4.0}) {
      const Particles from = stream(0), to = stream(later);
      const std::vector<char> jump = jumped(sightings(from, to, with_velocities), later * kFrame, with_velocities, 1);
      const bool any = 0.5 * later >= 1;  // the last layer is a spacing from the end
      ASSERT_EQ(jump.empty(), !any) << later;
      for (std::size_t i = 0; i < jump.size(); ++i)
        EXPECT_EQ(jump[i] != 0, to.positions[i].x() < from.positions[i].x()) << later << " " << i;
    }
  }
}

// What turns back at a wall, or is thrown out of fluid at rest, has moved.
TEST(Jumps, ImpactsAndSplashesAreNone) {
  std::vector<Sighting> particles(1000, Sighting{Vec3::Zero()});
  particles[0] = {Vec3(0.5, 0, 0), Vec3(300, 0, 0), Vec3(-290, 0, 0)};  // there and back, 10 spacings in all
  particles[1] = {Vec3(0, 5, 0), Vec3::Zero(), Vec3(0, 300, 0)};        // out of rest
  EXPECT_TRUE(jumped(particles, kFrame, true, 1).empty());
  particles[2] = {Vec3(0, 5, 0)};  // this one has no velocity that could have taken it there
  const std::vector<char> jump = jumped(particles, kFrame, true, 1);
  ASSERT_FALSE(jump.empty());
  EXPECT_TRUE(jump[2] && !jump[0] && !jump[1]);
}

// The velocities of the mesh, which are written and used by the next step, are the stream's in every state.
TEST(Jumps, TheStreamGoesOnAroundThem) {
  TrackerSettings settings;
  settings.spacing = 1;
  Tracker tracker(settings, stream(0));
  for (int frame = 1; frame <= 5; ++frame) {
    tracker.advance(stream(frame));
    double worst = 0;
    for (const Vec3& v : tracker.mesh().velocities)
      worst = std::max(worst, (v * kFrame - Vec3(0.5, 0, 0)).norm() / 0.5);
    EXPECT_LT(worst, 0.15) << frame;
  }
}

}  // namespace
}  // namespace flowskin::tracking::jumps_test
