// A mesh carried through a prescribed motion the way the paper does it: velocity, time step, projection, fairing.
#pragma once

#include <string>
#include <vector>

#include "scenes/scene.h"
#include "tools/experiments/error_measures.h"
#include "tools/experiments/material_motion.h"
#include "tracking/tracker.h"

namespace flowskin::tools {

/// What an experiment varies; the rest is the scene's.
struct RideSettings {
  std::string velocity;
  tracking::Integrator integrator = tracking::Integrator::rk4;
  int steps_per_period = 0;  ///< Period: a revolution, or the whole duration of a translation.
  int periods = 1;
  int fairing_iterations = 0;
  bool variable_springs = false;  ///< Soft where the field determines the velocity; false: as in the paper.
};

/// As the scene says.
RideSettings ride_settings(const scenes::Scene& scene);
/// "euler", "rk2", "rk4"
std::string integrator_name(tracking::Integrator integrator);

/// Errors against one truth at the end of a period; lengths in effective radii sigma.
struct RideErrors {
  Distances back;   ///< The paper's measure: distance of the vertices to their start. Sees whole revolutions only.
  Distances end;    ///< Distance to the true place now.
  double path = 0;  ///< Mean distance to the true place, averaged over all steps so far.
  double velocity_error = 0;  ///< Relative, averaged over all steps so far.
};

/// State at the end of a period.
struct RideCheckpoint {
  int period = 0;
  RideErrors errors;            ///< Against the scene's motion.
  RideErrors unspinning;        ///< Against a motion without spin.
  double strain = 0;            ///< RMS relative change of edge lengths since the start.
  int failed = 0;               ///< Vertices that the last projection could not bring onto the surface.
  std::vector<Vec3> positions;  ///< Of the vertices (m).
};

struct Ride {
  RideSettings settings;
  std::vector<RideCheckpoint> checkpoints;
  const RideCheckpoint& last() const { return checkpoints.back(); }
};

/// The mesh that all rides through a scene start from, on the surface at time 0.
tracking::SurfaceMesh start_mesh(const scenes::Scene& scene);

/// Carries `start`. Particles are exact at every evaluation, so that all errors are those of the method, the time step
/// and the fairing. Triangles never change: no remeshing, no repair, no guard.
Ride take_ride(const scenes::Scene& scene, const tracking::SurfaceMesh& start, const RideSettings& settings);

/// All of them, side by side, one thread each, in order. Same results at any number of threads.
std::vector<Ride> take_rides(const scenes::Scene& scene, const tracking::SurfaceMesh& start,
                             const std::vector<RideSettings>& settings);

}  // namespace flowskin::tools
