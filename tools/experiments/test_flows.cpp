#include "tools/experiments/test_flows.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <stdexcept>

#include "tracking/advection/integrator.h"
#include "tracking/advection/projection.h"
#include "tracking/extraction/extract_surface.h"
#include "tracking/field/metaballs/metaball_field.h"
#include "tracking/mesh/adjacency.h"
#include "tracking/velocity/velocity_method.h"

namespace flowskin::tools {
namespace {

using tracking::FieldSettings;
using tracking::MetaballField;

constexpr double kJitter = 0.2;  // spacings
constexpr double kEdge = 0.75;   // spacings
constexpr int kSteps = 20;
constexpr int kStepsOfTruth = 400;

/// Uniform numbers in [-1, 1) that are the same everywhere, which std::uniform_real_distribution's are not.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  Vec3 vector() {
    const double x = symmetric(), y = symmetric(), z = symmetric();
    return {x, y, z};
  }

 private:
  double symmetric() { return std::ldexp(static_cast<double>(engine_() >> 11U), -52) - 1; }
  std::mt19937_64 engine_;
};

FlowBody lattice_body(const std::string& name, double spacing, const Vec3& first,
                      const std::function<bool(const Vec3&)>& inside) {
  constexpr int most = 10;
  Random random(31);
  FlowBody body{name, spacing, {}};
  for (int i = 0; i < most; ++i) {
    for (int j = 0; j < most; ++j) {
      for (int k = 0; k < most; ++k) {
        const Vec3 place = spacing * (first + Vec3(i, j, k));
        const Vec3 moved = place + kJitter * spacing * random.vector();
        if (inside(place)) body.particles.push_back(moved);
      }
    }
  }
  return body;
}

std::vector<Vec3> particle_velocities(const std::vector<Vec3>& particles, const TestFlow& flow) {
  std::vector<Vec3> velocities;
  double sum = 0;
  for (const Vec3& x : particles) {
    velocities.push_back(flow.velocity(x));
    sum += velocities.back().squaredNorm();
  }
  const double speed = std::sqrt(sum / static_cast<double>(particles.size()));
  Random random(33);
  if (flow.noise > 0) {
    for (Vec3& v : velocities) v += flow.noise * speed * random.vector();  // its RMS is that factor
  }
  return velocities;
}

/// Where the flow takes a place in a time, by the classical Runge-Kutta method.
Vec3 carried(const TestFlow& flow, Vec3 x, double time) {
  const int steps = std::max(1, static_cast<int>(std::ceil(kStepsOfTruth * time)));
  const double h = time / steps;
  for (int i = 0; i < steps; ++i) {
    const Vec3 k1 = flow.velocity(x), k2 = flow.velocity(x + h / 2 * k1), k3 = flow.velocity(x + h / 2 * k2),
               k4 = flow.velocity(x + h * k3);
    x += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return x;
}

MetaballField field_at(const FlowBody& body, const FieldSettings& settings, const TestFlow& flow, double time) {
  std::vector<Vec3> particles;
  for (const Vec3& x : body.particles) particles.push_back(carried(flow, x, time));
  std::vector<Vec3> velocities = particle_velocities(particles, flow);
  return MetaballField(std::move(particles), std::move(velocities), settings);
}

}  // namespace

const std::vector<TestFlow>& test_flows() {
  constexpr double pi = std::numbers::pi;
  const auto rotation = [](const Vec3& x) -> Vec3 { return Vec3(0.3, 1, 0.2).cross(x); };
  static const std::vector<TestFlow> flows = {
      {"translation", [](const Vec3&) { return Vec3(0.7, -0.3, 0.5); }},
      {"rotation", rotation},
      {"shear", [](const Vec3& x) { return Vec3(x.y(), 0, 0); }},
      {"stretch", [](const Vec3& x) { return Vec3(x.x(), -x.y() / 2, -x.z() / 2); }},
      {"vortex",
       [](const Vec3& x) {
         return Vec3(-std::sin(pi * x.x()) * std::cos(pi * x.y()), std::cos(pi * x.x()) * std::sin(pi * x.y()), 0);
       }},
      {"rotation + noise", rotation, 0.05}};
  return flows;
}

const TestFlow& test_flow(const std::string& name) {
  for (const TestFlow& flow : test_flows()) {
    if (flow.name == name) return flow;
  }
  throw std::out_of_range("there is no test flow \"" + name + "\"");
}

FlowBody test_ball() {
  return lattice_body("ball", 0.5 / 4.35, Vec3::Constant(-4.5), [](const Vec3& x) { return x.norm() < 0.5; });
}

FlowBody test_block() {
  return lattice_body("block", 1.0 / 7, Vec3::Constant(-3),
                      [](const Vec3& x) { return x.cwiseAbs().maxCoeff() < 0.5; });
}

FlowErrors velocity_errors(const std::string& method, const FlowBody& body, double radius, const TestFlow& flow) {
  return velocity_errors(*tracking::make_velocity_method(method), body, radius, flow);
}

FlowErrors velocity_errors(const tracking::VelocityMethod& method, const FlowBody& body, double radius,
                           const TestFlow& flow) {
  const FieldSettings settings = tracking::default_field_settings(body.spacing, radius);
  const MetaballField field = field_at(body, settings, flow, 0);
  const auto surface = tracking::extract_surface(field, kEdge * body.spacing);
  const auto topology = tracking::build_adjacency(static_cast<int>(surface.positions.size()), surface.triangles);
  std::vector<Vec3> velocities;
  method.evaluate(field, topology, surface.positions, velocities);

  std::vector<double> errors;
  double error2 = 0, speed2 = 0;
  for (std::size_t v = 0; v < velocities.size(); ++v) {
    const Vec3 truth = flow.velocity(surface.positions[v]);
    errors.push_back((velocities[v] - truth).norm());
    error2 += errors.back() * errors.back();
    speed2 += truth.squaredNorm();
  }
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  return {std::sqrt(error2 / speed2), *middle / std::sqrt(speed2 / static_cast<double>(errors.size()))};
}

double path_error(const std::string& method, const FlowBody& body, double radius, const TestFlow& flow) {
  const FieldSettings settings = tracking::default_field_settings(body.spacing, radius);
  const auto velocity = tracking::make_velocity_method(method);
  MetaballField field = field_at(body, settings, flow, 0);
  const auto surface = tracking::extract_surface(field, kEdge * body.spacing);
  const auto topology = tracking::build_adjacency(static_cast<int>(surface.positions.size()), surface.triangles);
  std::vector<Vec3> positions = surface.positions;
  const auto at = [&](double time) { return field_at(body, settings, flow, time); };
  const auto shared_at = [&](double time) { return tracking::shared_field(at(time)); };
  for (int step = 0; step < kSteps; ++step) {
    const double time = static_cast<double>(step) / kSteps, next = static_cast<double>(step + 1) / kSteps;
    tracking::advect_step(*velocity, topology, tracking::Integrator::rk2, field, shared_at, time, next - time, {},
                          positions);
    field = at(next);
    tracking::project_to_surface(field, tracking::default_projection(settings.scale()), positions);
  }
  double sum = 0;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    sum += (positions[v] - carried(flow, surface.positions[v], 1)).norm();
  }
  return sum / static_cast<double>(positions.size()) / body.spacing;
}

}  // namespace flowskin::tools
