// Bodies of particles in flows that are known everywhere: how wrong is each velocity method?
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tracking/velocity/velocity_method.h"

namespace flowskin::tools {

using tracking::Vec3;

/// Velocity of the material (m/s) at each place (m).
struct TestFlow {
  std::string name;
  std::function<Vec3(const Vec3&)> velocity;
  double noise = 0;  ///< RMS of random velocities added to the particles, in RMS speeds of the particles.
};

/// translation, rotation, shear, stretch, vortex, rotation + noise.
const std::vector<TestFlow>& test_flows();
/// @throws std::out_of_range
const TestFlow& test_flow(const std::string& name);

/// Particles on a jittered cubic lattice (0.2 spacings at most along each axis).
struct FlowBody {
  std::string name;
  double spacing;  ///< m
  std::vector<Vec3> particles;
};

/// A ball of 360 particles, 1 m across.
FlowBody test_ball();
/// A block of 7 x 7 x 7 particles, 1 m across.
FlowBody test_block();

/// Over the vertices of the body's surface.
struct FlowErrors {
  double relative_rms = 0;  ///< RMS of |v - truth| by RMS of |truth|.
  double median = 0;        ///< Median of |v - truth| by RMS of |truth|.
};

/// @param radius effective radius of a particle, in spacings
FlowErrors velocity_errors(const tracking::VelocityMethod& method, const FlowBody& body, double radius,
                           const TestFlow& flow);
/// The same for a method of the registry.
FlowErrors velocity_errors(const std::string& method, const FlowBody& body, double radius, const TestFlow& flow);

/// Mean distance (spacings) between the vertices, carried for one second in 20 steps of the midpoint rule with
/// projection and without fairing, and where the flow takes them.
double path_error(const std::string& method, const FlowBody& body, double radius, const TestFlow& flow);

}  // namespace flowskin::tools
