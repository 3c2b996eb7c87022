#include <cstdio>

#include "sph/solver.h"
#include "tracking/tracker.h"

using namespace flowskin;

int main() {
  // A ball of syrup, 10 cm across, falls freely and turns.
  sph::SimulationSetup setup;
  setup.settings.spacing = 0.01;     // m
  setup.settings.viscosity = 0.005;  // m^2/s
  sph::FluidBody ball;
  ball.shape = sph::FluidBody::Shape::ball;
  ball.radius = 0.05;                 // m
  ball.angular_velocity = {0, 0, 3};  // rad/s
  setup.bodies.push_back(ball);
  sph::Solver solver(setup);

  // The tracker takes particles from anywhere: positions, velocities and where their material was at first.
  const auto particles = [&] {
    sph::FluidState state = solver.state();
    return tracking::Particles{state.time, state.ids, state.positions, state.velocities, state.rest_positions};
  };
  tracking::TrackerSettings settings;
  settings.spacing = setup.settings.spacing;
  settings.velocity = "hybrid";
  tracking::Tracker tracker(settings, particles());

  for (int frame = 1; frame <= 5; ++frame) {
    solver.advance_to(frame / 60.0);
    tracker.advance(particles());
    std::printf("t = %.3f s: %zu vertices, volume %.3g m^3\n", solver.time(), tracker.mesh().positions.size(),
                tracker.report().volume);
  }
}
