// Particles whose paths are unknown: fields that go from one state's to the other's, and surfaces tracked in them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "tests/tracking/mesh_test_shapes.h"
#include "tracking/advection/particle_paths.h"
#include "tracking/material/material.h"
#include "tracking/mesh/mesh_check.h"
#include "tracking/tracker.h"

namespace flowskin::tracking::blended_states_test {
namespace {

using test::joined;
using test::particles_at;

/// An ellipsoid of jittered particles of spacing 1, without symmetry to speak of.
std::vector<Vec3> ellipsoid() {
  return test::lattice(1.0, 8, 0.15, 4, [](const Vec3& x) { return x.cwiseQuotient(Vec3(6.5, 4.5, 3.5)).norm() <= 1; });
}

/// A smooth motion that is neither rigid nor steady, and its velocity.
Vec3 place_at(const Vec3& x, double t) {
  return test::rotation(Vec3(0.3, -0.2, 0.5) * t) * x + Vec3(t, 0.5 * t * t, -0.3 * t) + 0.02 * t * x.cwiseProduct(x);
}
Vec3 velocity_at(const Vec3& x, double t) {
  const Vec3 spin(0.3, -0.2, 0.5);
  return spin.cross(test::rotation(spin * t) * x) + Vec3(1, t, -0.3) + 0.02 * x.cwiseProduct(x);
}

enum Known { nothing = 0, velocities = 1, everything = 2 };

/// The particles at a time. Without lasting ids their order changes as well, so that it tells nothing.
Particles state_at(const std::vector<Vec3>& start, double t, Known known) {
  Particles particles = particles_at(start);
  particles.time = t;
  for (std::size_t i = 0; i < start.size(); ++i) {
    const std::size_t from = known == everything ? i : (i * 7919 + static_cast<std::size_t>(1000 * t)) % start.size();
    particles.positions[i] = place_at(start[from], t);
    particles.velocities[i] = velocity_at(start[from], t);
  }
  if (known == everything) return particles;
  particles.has_lasting_ids = false;
  particles.rest_positions.clear();
  if (known == nothing) particles.velocities.clear();
  return particles;
}

TEST(BlendedStates, RatesOfTwoStatesConvergeToTheClosedFormWithSecondOrder) {
  const std::vector<Vec3> start = ellipsoid();
  const FieldSettings settings = default_field_settings(1);
  const double middle = 0.4;
  const MetaballField exact = field_of(state_at(start, middle, everything), settings);
  std::vector<Vec3> points;  // near the surface
  for (const Vec3& x : start)
    if (exact.value(place_at(x, middle)) < 0.5 * settings.threshold) points.push_back(place_at(x, middle));
  ASSERT_GT(points.size(), 100U);
  Vec3 last = Vec3::Zero();
  for (const double dt : {0.04, 0.02, 0.01, 0.005}) {
    const ParticlePaths paths(state_at(start, middle - dt / 2, nothing), state_at(start, middle + dt / 2, nothing));
    ASSERT_TRUE(paths.blended());
    const MetaballField field = paths.field(middle, settings);
    Vec3 error = Vec3::Zero(), size = Vec3::Zero();  // of the rates of value, gradient, Hessian
    for (const Vec3& x : points) {
      const MotionJet jet = field.motion_jet(x), wanted = exact.motion_jet(x);
      error += Vec3(std::abs(jet.value_rate - wanted.value_rate), (jet.gradient_rate - wanted.gradient_rate).norm(),
                    (jet.hessian_rate - wanted.hessian_rate).norm());
      size += Vec3(std::abs(wanted.value_rate), wanted.gradient_rate.norm(), wanted.hessian_rate.norm());
    }
    error = error.cwiseQuotient(size);
    // The kernel's third derivatives jump at the rim of its support, so the rates of gradient and Hessian come in more
    // slowly than the second order of the value's.
    if (last[0] > 0) {
      const Vec3 order = last.cwiseQuotient(error).array().log() / std::log(2.0);
      EXPECT_NEAR(order[0], 2, 0.1) << dt;
      EXPECT_GT(order[1], 1.5) << dt;
      EXPECT_GT(order[2], 0.7) << dt;
    }
    last = error;
  }
  EXPECT_LT(last[0], 2e-5);
  EXPECT_LT(last[1], 5e-4);
  EXPECT_LT(last[2], 0.04);
}

TEST(BlendedStates, TheBlendIsAFieldWhoseRatesAreItsOwn) {
  const std::vector<Vec3> start = ellipsoid();
  const FieldSettings settings = default_field_settings(1);
  for (const Known known : {nothing, velocities}) {
    const Particles from = state_at(start, 0, known), to = state_at(start, 0.3, known);
    const ParticlePaths paths(from, to);
    const Vec3 x(5.9, 0.3, -0.4);
    const double h = 1e-5;
    for (const double t : {0.05, 0.2}) {
      const MotionJet jet = paths.field(t, settings).motion_jet(x);
      const MotionJet before = paths.field(t - h, settings).motion_jet(x),
                      after = paths.field(t + h, settings).motion_jet(x);
      EXPECT_NEAR(jet.value_rate, (after.moving_value - before.moving_value) / (2 * h), 1e-6);
      EXPECT_LT((jet.gradient_rate - (after.gradient - before.gradient) / (2 * h)).norm(), 1e-6);
      EXPECT_LT((jet.hessian_rate - (after.hessian - before.hessian) / (2 * h)).norm(), 1e-5);
      Vec3 gradient;
      EXPECT_NEAR(paths.field(t, settings).value(x, gradient), jet.moving_value, 1e-12);
      EXPECT_LT((gradient - jet.gradient).norm(), 1e-12);
    }
    // At both ends it is the field of that state.
    EXPECT_EQ(paths.field(0, settings).value(x), field_of(from, settings).value(x));
    EXPECT_EQ(paths.field(0.3, settings).value(x), field_of(to, settings).value(x));
    EXPECT_EQ(paths.field(0.15, settings).velocities().empty(), known == nothing);
    EXPECT_GT(paths.mismatch(), 0);
  }
}

TEST(BlendedStates, VelocitiesMakeTheBlendBetter) {
  const std::vector<Vec3> start = ellipsoid();
  const FieldSettings settings = default_field_settings(1);
  const double dt = 0.3;
  const auto error = [&](Known known) {
    const ParticlePaths paths(state_at(start, 0, known), state_at(start, dt, known));
    const MetaballField exact = field_of(state_at(start, dt / 2, everything), settings);
    const MetaballField field = paths.field(dt / 2, settings);
    double largest = 0;
    for (const Vec3& x : {Vec3(6.3, 0.4, 0.1), Vec3(-3, 3, 1), Vec3(1, -2, 3.2)})
      largest = std::max(largest, std::abs(field.value(x) - exact.value(x)));
    return largest;
  };
  EXPECT_LT(error(velocities), 0.2 * error(nothing));
}

/// Root mean square distance of the vertices from where their material is (spacings); it is known by the rest position.
double path_error(const SurfaceMesh& mesh, const Vec3& drift, double t) {
  double sum = 0;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    sum += (mesh.positions[v] - mesh.rest_positions[v] - drift * t).squaredNorm();
  return std::sqrt(sum / static_cast<double>(mesh.positions.size()));
}

/// Path error after a second (2.3 spacings) at these many states per second, relative to the path.
double translation_error(const std::string& method, int states, Known known) {
  const std::vector<Vec3> start = ellipsoid();
  const Vec3 drift(2, -1, 0.5);
  const auto state = [&](double t) {
    Particles particles = state_at(start, 0, known);
    particles.time = t;
    for (Vec3& x : particles.positions) x += drift * t;
    if (known == velocities) particles.velocities.assign(start.size(), drift);
    std::rotate(particles.positions.begin(), particles.positions.begin() + static_cast<int>(100 * t),
                particles.positions.end());
    return particles;
  };
  TrackerSettings settings;
  settings.spacing = 1;
  settings.velocity = method;
  Tracker tracker(settings, state(0));
  EXPECT_EQ(tracker.mesh().positions, tracker.mesh().rest_positions);
  for (int k = 1; k <= states; ++k) {
    tracker.advance(state(static_cast<double>(k) / states));
    EXPECT_EQ(joined(mesh_problems(tracker.mesh())), "");
    EXPECT_TRUE(tracker.report().blended);
    EXPECT_FALSE(tracker.report().reextracted) << tracker.report().reason;
    if (known == nothing) {
      EXPECT_NEAR(tracker.report().mismatch, drift.norm() / states, 0.02);
    }
  }
  return path_error(tracker.mesh(), drift, 1) / drift.norm();
}

TEST(BlendedStates, ATranslatingBodyWithoutIdsIsTracked) {
  const std::map<std::string, double> bounds = {{"affine", 0.08}, {"total", 0.4}};
  for (const auto& [method, bound] : bounds) {
    // With velocities the blend of the moved states is exact here, and fairing leaves the material where it is.
    EXPECT_LT(translation_error(method, 10, velocities), 1e-10) << method;
    // Without them the surface lags behind along itself, by a share of its path that falls with the step: here of 0.09
    // and 0.045 effective radii.
    const double coarse = translation_error(method, 10, nothing), fine = translation_error(method, 20, nothing);
    EXPECT_LT(coarse, bound) << method;
    // Fairing that drags the material along would hide some of it: it carries the motion of the ends into the sides.
    EXPECT_LT(fine, 0.8 * coarse) << method;
  }
}

TEST(BlendedStates, NewSurfaceTakesThePlaceBesideTheOldOnes) {
  // A body far from its rest position grows a second part beside it.
  const std::vector<Vec3> ball = test::ball_of_particles(3.2);
  SurfaceMesh old_mesh;
  Particles particles = particles_at(ball);
  particles.rest_positions.clear();
  const FieldSettings settings = default_field_settings(1);
  const MetaballField field = field_of(particles, settings);
  TrackerSettings tracker_settings;
  tracker_settings.spacing = 1;
  const Tracker tracker(tracker_settings, particles);
  old_mesh = tracker.mesh();
  const Vec3 moved(10, 0, 0);
  for (Vec3& rest : old_mesh.rest_positions) rest -= moved;
  const Vec3 outward = old_mesh.positions[0].normalized();
  SurfaceGeometry fresh{{old_mesh.positions[0] + 2 * outward, Vec3(100, 0, 0)}, {}};
  MaterialSettings material;
  material.reach = 0.75;
  material.same_vertex = 0.25;
  material.far_reach = 5;
  const SurfaceMesh mesh = carry_material(old_mesh, fresh, {outward, Vec3(1, 0, 0)}, field, particles, material);
  EXPECT_LT((mesh.rest_positions[0] - (fresh.positions[0] - moved)).norm(), 1e-9);
  EXPECT_EQ(mesh.rest_positions[1], fresh.positions[1]);  // nothing is near: its own place
}

TEST(BlendedStates, WeightsOfAStateArePartOfTheField) {
  const std::vector<Vec3> start = ellipsoid();
  const FieldSettings settings = default_field_settings(1);
  const Particles from = state_at(start, 0, nothing), to = state_at(start, 0.3, nothing);
  // A state a third of the way, as a recording gives it in a gap.
  Particles third;
  third.time = 0.1;
  third.has_lasting_ids = false;
  for (const auto& [state, weight] : {std::pair(&from, 2.0 / 3), std::pair(&to, 1.0 / 3)}) {
    third.positions.insert(third.positions.end(), state->positions.begin(), state->positions.end());
    third.weights.insert(third.weights.end(), state->positions.size(), weight);
  }
  for (std::size_t i = 0; i < third.positions.size(); ++i) third.ids.push_back(i);
  EXPECT_NO_THROW(check_particles(third));
  const MetaballField direct = ParticlePaths(from, to).field(0.2, settings);
  const MetaballField by_way = ParticlePaths(third, to).field(0.2, settings);
  for (const Vec3& x : {Vec3(6.3, 0.4, 0.1), Vec3(-3, 3, 1)}) {
    EXPECT_NEAR(by_way.value(x), direct.value(x), 1e-12);
    EXPECT_LT((by_way.motion_jet(x).gradient_rate - direct.motion_jet(x).gradient_rate).norm(), 1e-11);
  }
  TrackerSettings tracker_settings;
  tracker_settings.spacing = 1;
  tracker_settings.velocity = "affine";
  Tracker tracker(tracker_settings, from);
  tracker.advance(third);
  tracker.advance(to);
  EXPECT_EQ(joined(mesh_problems(tracker.mesh())), "");
  third.weights[3] = -1;
  EXPECT_THROW(check_particles(third), std::invalid_argument);
}

TEST(BlendedStates, MethodsThatNeedVelocitiesAreRefusedWithoutAny) {
  const Particles silent = state_at(ellipsoid(), 0, nothing);
  for (const VelocityMethodInfo& method : velocity_methods()) {
    TrackerSettings settings;
    settings.spacing = 1;
    settings.velocity = method.name;
    if (method.needs_particle_velocities) {
      EXPECT_THROW(Tracker(settings, silent), std::invalid_argument) << method.name;
    } else {
      EXPECT_GT(Tracker(settings, silent).mesh().positions.size(), 100U) << method.name;
    }
  }
  EXPECT_TRUE(needs_particle_velocities("simulation"));
  EXPECT_TRUE(needs_particle_velocities("hybrid"));
  EXPECT_FALSE(needs_particle_velocities("affine"));
}

/// Whatever a recording does, the mesh stays sound and nothing is NaN.
TEST(BlendedStates, BadSequencesAreSurvived) {
  const std::vector<Vec3> ball = test::ball_of_particles(4.2);
  for (const Known known : {nothing, velocities, everything}) {
    TrackerSettings settings;
    settings.spacing = 1;
    settings.velocity = known == nothing ? "affine" : "hybrid";
    const auto state = [&](double t, std::size_t first, std::size_t last, const Vec3& shift) {
      Particles particles =
          state_at({ball.begin() + static_cast<int>(first), ball.begin() + static_cast<int>(last)}, 0, known);
      particles.time = t;
      for (Vec3& x : particles.positions) x += shift;
      return particles;
    };
    const std::size_t all = ball.size();
    Tracker tracker(settings, state(0, 0, all, Vec3::Zero()));
    const auto go = [&](const Particles& particles) {
      tracker.advance(particles);
      EXPECT_EQ(joined(mesh_problems(tracker.mesh())), "") << known << " at " << particles.time;
      for (const Vec3& v : tracker.mesh().velocities) EXPECT_TRUE(v.allFinite());
      for (const Vec3& x : tracker.mesh().rest_positions) EXPECT_TRUE(x.allFinite());
      EXPECT_LE(tracker.report().substeps, 1000);
    };
    go(state(0.1, 0, all / 2, Vec3::Zero()));             // half of the particles vanish
    go(state(0.2, 0, all, Vec3::Zero()));                 // and come back
    go(state(0.3, 0, all, Vec3(30, 0, 0)));               // the whole body jumps
    go(state(0.3, 0, all, Vec3(31, 0, 0)));               // no time goes by
    go(state(0.4, 0, 0, Vec3::Zero()));                   // nothing is left
    go(state(0.5, 0, all, Vec3::Zero()));                 // and comes back
    Particles jumped = state(0.6, 0, all, Vec3::Zero());  // a few particles jump
    for (std::size_t i = 0; i < 5; ++i) jumped.positions[i * 20] += Vec3(0, 1000, 0);
    go(jumped);
    EXPECT_LT(tracker.report().substeps, 1000);
    EXPECT_GT(tracker.mesh().positions.size(), 0U);
  }
}

// One in a row of particles, all of which move upwards, is taken out and put in far away: it goes on for a while where
// it was, comes in where it will be, and has its velocity at both places.
TEST(ParticlePaths, AParticleThatJumpsGoesHereAndComesThere) {
  std::vector<Vec3> row;
  for (int i = 0; i < 30; ++i) row.emplace_back(i, 0, 0);
  Particles from = particles_at(row), to = particles_at(row);
  to.time = 1;
  const Vec3 velocity(0, 0.1, 0);
  for (Vec3& x : to.positions) x += velocity;
  for (std::size_t i = 0; i < row.size(); ++i) from.velocities[i] = to.velocities[i] = velocity;
  to.positions[4] += Vec3(0, 500, 0);
  const ParticlePaths paths(from, to, 1);
  EXPECT_LT(paths.longest_path(), 0.2);
  std::vector<Vec3> positions, speeds;
  for (const double time : {0.0, 0.5}) {
    paths.at(time, positions, speeds);
    EXPECT_EQ(positions.size(), 31U);  // it is at both places
    for (const Vec3& speed : speeds) EXPECT_LT((speed - velocity).norm(), 1e-12);
  }
  paths.at(1, positions, speeds);
  EXPECT_EQ(positions, to.positions);
  EXPECT_EQ(speeds, to.velocities);
  EXPECT_GT(ParticlePaths(from, to).longest_path(), 500);
}

}  // namespace
}  // namespace flowskin::tracking::blended_states_test
