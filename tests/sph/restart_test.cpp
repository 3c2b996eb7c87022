// A solver that is saved and restored goes on as if nothing had been, whatever features its set-up uses. Each feature
// that keeps something from step to step has a case here: it fails where that is forgotten in SolverImpl::visit.
#include <gtest/gtest.h>
#include <omp.h>

#include <cstring>
#include <functional>
#include <string>

#include "tests/sph/test_meshes.h"

namespace flowskin::sph::restart_test {
namespace {

std::string saved(const Solver& solver) {
  std::string bytes;
  StateWriter writer([&](std::string_view piece) { bytes += piece; });
  solver.save(writer);
  writer.flush();
  return bytes;
}

void restore(Solver& solver, const std::string& bytes) {
  StateReader reader(bytes);
  solver.restore(reader);
  EXPECT_EQ(reader.bytes_left(), 0U);
}

/// What a run shows of its fluid, bit for bit. Seconds spent are left out.
std::string shown(const Solver& solver) {
  std::string bytes;
  StateWriter writer([&](std::string_view piece) { bytes += piece; });
  const FluidState state = solver.state();
  const SolverStatistics& s = solver.statistics();
  writer(state.time, state.ids, state.positions, state.velocities, state.rest_positions, state.densities);
  writer(s.steps, s.list_rebuilds, s.left_domain, s.wall_crossings, s.emitted, s.last_step);
  writer.flush();
  return bytes;
}

struct Case {
  std::string name;
  std::function<SimulationSetup()> setup;
};

/// A block that falls into a box: walls, impact, neighbour lists in every state of age.
SimulationSetup splash() {
  SimulationSetup setup = block_setup(0.025, {0.05, 0.1, 0.05}, {0.2, 0.3, 0.2});
  setup.settings.viscosity = 1e-3;
  setup.boundaries.push_back(tank(closed_box({0, 0, 0}, {0.3, 0.6, 0.3}), 0.5));
  return setup;
}

std::vector<Case> cases() {
  return {
      {"Walls", splash},
      {"FreeBody",
       [] {
         SimulationSetup setup = block_setup(0.025, {0, 0, 0}, {0.2, 0.2, 0.2});
         setup.bodies[0].angular_velocity = {0, 3, 5};
         return setup;
       }},
      {"EmitterAndDomain",
       [] {
         SimulationSetup setup = splash();
         setup.emitters.push_back({{0.15, 0.5, 0.15}, {1, -1, 0}, 0.06, 2.0, 0.01, 0.07});
         setup.emitters.push_back({{0.1, 0.5, 0.1}, {0, -1, 0}, 0.04, 1.0, 0.02, 1e30});
         setup.settings.domain = {{0, 0.03, 0}, {0.3, 0.6, 0.17}};
         return setup;
       }},
      {"ImplicitViscosity",
       [] {
         SimulationSetup setup = splash();
         setup.settings.viscosity = 1;
         setup.settings.viscosity_solver = ViscositySolver::implicit;
         return setup;
       }},
      {"PeriodicDomain",
       [] {
         SimulationSetup setup = block_setup(0.025, {0.05, 0, 0.05}, {0.25, 0.2, 0.2});
         setup.bodies[0].velocity = {4, 0, 3};  // across the seams, several times
         setup.settings.viscosity = 1e-3;
         setup.settings.domain = {{0, 0, 0}, {0.3, 0, 0.3}};
         setup.settings.periodic = {true, false, true};
         return setup;
       }},
      {"SurfaceTensionAndAdhesion",
       [] {
         SimulationSetup setup = splash();
         setup.settings.surface_tension = 5;
         for (Boundary& wall : setup.boundaries) wall.adhesion = 0.4;
         return setup;
       }},
      {"BlockedMeshEmitterAndSinks",
       [] {
         SimulationSetup setup = splash();
         Emitter emitter;
         emitter.shape = Emitter::Shape::mesh;
         emitter.mesh = sphere({0.15, 0.06, 0.1}, 0.05, 8);
         emitter.speed = 1;
         setup.emitters.push_back(emitter);
         Sink sink;
         sink.shape = Sink::Shape::ball;
         sink.center = {0.05, 0.02, 0.05};
         sink.radius = 0.04;
         sink.start = 0.02;
         setup.sinks.push_back(sink);
         return setup;
       }},
      {"Xsph",
       [] {
         SimulationSetup setup = splash();
         setup.settings.xsph = 0.3;
         return setup;
       }},
      {"MovingWalls",
       [] {
         SimulationSetup setup = splash();
         Boundary paddle{closed_box({0.14, 0, 0.1}, {0.16, 0.3, 0.2}), 0};
         paddle.motion.pivot = {0.15, 0, 0.15};
         paddle.motion.keyframes = {{0.01, Vec3::Zero(), Vec3::Zero()}, {0.08, {0, 0.05, 0}, {0, 90, 0}}};
         setup.boundaries.push_back(paddle);
         setup.boundaries[0].surface_velocity = {0.3, 0, 0};
         return setup;
       }},
      {"Periodic",
       [] {
         SimulationSetup setup = splash();
         setup.settings.domain = {{0, -1, 0}, {0.3, 1, 0.3}};
         setup.settings.periodic = {true, false, true};
         setup.bodies[0].velocity = {2, 0, 1};
         setup.boundaries = {{sheet(1, 0), 0.5}};
         return setup;
       }},
      {"ContinuityDensity",
       [] {
         SimulationSetup setup = splash();
         setup.settings.density_method = DensityMethod::continuity;
         return setup;
       }},
      {"Shifting",
       [] {
         SimulationSetup setup = block_setup(0.025, {0, 0, 0}, {0.2, 0.2, 0.2});
         setup.bodies[0].block.max.y() = 0.1;
         setup.bodies[0].velocity = {1, 0, 0.3};
         setup.bodies.push_back(setup.bodies[0]);
         setup.bodies[1].block = {{0, 0.1, 0}, {0.2, 0.2, 0.2}};
         setup.bodies[1].velocity = {-1, 0.2, 0};
         setup.settings.domain = {{0, 0, 0}, {0.2, 0.2, 0.2}};
         setup.settings.periodic = {true, true, true};
         setup.settings.density_method = DensityMethod::continuity;
         setup.settings.particle_shifting = 1;
         return setup;
       }},
      {"WallDrag",
       [] {
         SimulationSetup setup = splash();
         setup.settings.viscosity = 1e-6;
         setup.settings.wall_drag = 1;
         setup.bodies[0].velocity = {1, -1, 0.5};
         return setup;
       }},
      {"MorrisViscosityAndCubicSpline",
       [] {
         SimulationSetup setup = splash();
         setup.settings.viscosity = 0.05;
         setup.settings.viscosity_form = ViscosityForm::morris;
         setup.settings.kernel = KernelType::cubic_spline;
         return setup;
       }},
  };
}

class Restart : public ::testing::TestWithParam<Case> {};

TEST_P(Restart, GoesOnBitForBit) {
  constexpr double end = 0.1;
  Solver straight(GetParam().setup());
  straight.advance_to(end);
  const std::string wanted = shown(straight);

  // Stops after 1, 2, 3, 5, 8, ... steps each, so that lists are of every age; each time another solver goes on.
  auto solver = std::make_unique<Solver>(GetParam().setup());
  const int threads = omp_get_max_threads();
  int stops = 0;
  for (int before = 0, steps = 1; solver->time() < end; ++stops) {
    int left = steps;
    const bool arrived = solver->advance_towards(end, [&] { return left-- == 0; });
    const std::string bytes = saved(*solver);
    auto next = std::make_unique<Solver>(GetParam().setup());
    restore(*next, bytes);
    EXPECT_EQ(shown(*next), shown(*solver)) << "after stop " << stops;
    EXPECT_EQ(saved(*next), bytes) << "after stop " << stops;
    solver = std::move(next);
    omp_set_num_threads(1 + stops % 2);
    before = std::exchange(steps, before + steps);
    if (arrived) break;
  }
  omp_set_num_threads(threads);
  EXPECT_GT(stops, 4);
  // Not EXPECT_EQ: its message would be megabytes long.
  EXPECT_TRUE(shown(*solver) == wanted);
  EXPECT_EQ(solver->statistics().steps, straight.statistics().steps);
}

INSTANTIATE_TEST_SUITE_P(Features, Restart, ::testing::ValuesIn(cases()),
                         [](const auto& instance) { return instance.param.name; });

TEST(RestartErrors, SavingDisturbsNothing) {
  Solver quiet(splash()), disturbed(splash());
  for (int k = 1; k <= 10; ++k) {
    quiet.advance_to(0.005 * k);
    disturbed.advance_to(0.005 * k);
    saved(disturbed);
  }
  EXPECT_TRUE(shown(quiet) == shown(disturbed));
}

TEST(RestartErrors, CutOffAnywhereIsRefused) {
  Solver solver(splash());
  const std::string bytes = saved(solver);
  for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 50) {
    Solver other(splash());
    StateReader reader(std::string_view(bytes).substr(0, size));
    EXPECT_THROW(other.restore(reader), StateError) << size;
  }
}

TEST(RestartErrors, AnotherSetUpIsRefused) {
  Solver solver(splash());
  const std::string bytes = saved(solver);
  SimulationSetup pouring = splash();
  pouring.emitters.push_back({{0.15, 0.5, 0.15}, {0, -1, 0}, 0.06, 2.0});
  Solver other(pouring);
  StateReader reader(bytes);
  EXPECT_THROW(other.restore(reader), StateError);
}

TEST(RestartErrors, FasterSoundAfterwardsIsAllowed) {
  Solver slow(splash());
  slow.advance_to(0.05);
  SimulationSetup faster = splash();
  faster.settings.max_speed = 2 * slow.settings().max_speed;
  Solver fast(faster);
  restore(fast, saved(slow));
  fast.advance_to(0.1);
  EXPECT_GT(fast.settings().speed_of_sound, 1.9 * slow.settings().speed_of_sound);
  EXPECT_LT(fast.statistics().last_step.acoustic, 0.6 * slow.statistics().last_step.acoustic);
}

/// Whatever stands in a state: it is refused, or what follows stays in its arrays (sanitizers look at this test).
TEST(Restart, AlteredStatesAreRefusedOrHarmless) {
  SimulationSetup setup = block_setup(0.05, {0.05, 0.1, 0.05}, {0.15, 0.2, 0.15});
  setup.settings.wall_drag = 1;
  setup.settings.xsph = 0.1;
  setup.settings.max_speed = 2;
  setup.boundaries.push_back(tank(closed_box({0, 0, 0}, {0.3, 0.6, 0.3}), 0.5));
  Emitter emitter;
  emitter.center = {0.15, 0.4, 0.15};
  emitter.radius = 0.05;
  emitter.speed = 1;
  setup.emitters = {emitter};
  Solver first(setup);
  first.advance_to(0.02);
  const std::string bytes = saved(first);
  int refused = 0, taken = 0;
  Solver solver(setup);
  for (std::size_t at = 0; at + 8 <= bytes.size(); at += 4) {
    for (const std::uint64_t value : {std::uint64_t{0}, std::uint64_t{3}, std::uint64_t{1} << 40, ~std::uint64_t{0}}) {
      std::string altered = bytes;
      std::memcpy(altered.data() + at, &value, 8);
      StateReader reader(altered);
      try {
        solver.restore(reader);
        ++taken;
        solver.step(1e-4);
      } catch (const StateError&) {
        ++refused;
      } catch (const BlowUpError&) {
      }
    }
  }
  EXPECT_GT(refused, 100);
  EXPECT_GT(taken, 100);
  restore(solver, bytes);
  EXPECT_EQ(shown(solver), shown(first));
}

}  // namespace
}  // namespace flowskin::sph::restart_test
