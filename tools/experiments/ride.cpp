#include "tools/experiments/ride.h"

#include <cmath>
#include <exception>
#include <numeric>
#include <utility>

#include "common/errors.h"
#include "tools/pipeline/interruption.h"
#include "tools/pipeline/tracker_bridge.h"
#include "tracking/advection/integrator.h"
#include "tracking/advection/projection.h"
#include "tracking/extraction/extract_surface.h"
#include "tracking/fairing/fairing.h"
#include "tracking/mesh/adjacency.h"
#include "tracking/velocity/velocity_method.h"

namespace flowskin::tools {
namespace {

std::vector<Vec3> true_positions(const MaterialMotion& motion, const std::vector<Vec3>& starts, double time,
                                 Truth truth) {
  std::vector<Vec3> positions;
  positions.reserve(starts.size());
  for (const Vec3& start : starts) positions.push_back(motion.position(start, time, truth));
  return positions;
}

std::vector<Vec3> true_velocities(const MaterialMotion& motion, const std::vector<Vec3>& places, double time,
                                  Truth truth) {
  std::vector<Vec3> velocities;
  velocities.reserve(places.size());
  for (const Vec3& place : places) velocities.push_back(motion.velocity(place, time, truth));
  return velocities;
}

// Gathers the errors against one truth.
class ErrorLog {
 public:
  ErrorLog(const MaterialMotion& motion, Truth truth, const std::vector<Vec3>& starts)
      : motion_(motion), truth_(truth), starts_(starts) {}

  void add_velocities(const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities, double time) {
    velocity_.add(relative_velocity_error(velocities, true_velocities(motion_, positions, time, truth_)));
  }
  void add_positions(const std::vector<Vec3>& positions, double time) {
    end_ = distances(positions, true_positions(motion_, starts_, time, truth_));
    path_.add(end_.mean);
  }
  /// In effective radii.
  RideErrors errors(const std::vector<Vec3>& positions) const {
    const double unit = 1 / motion_.field_settings().radius;
    const Distances back = distances(positions, starts_);
    return {{unit * back.mean, unit * back.max},
            {unit * end_.mean, unit * end_.max},
            unit * path_.mean(),
            velocity_.mean()};
  }

 private:
  const MaterialMotion& motion_;
  Truth truth_;
  const std::vector<Vec3>& starts_;
  Average path_, velocity_;
  Distances end_;
};

// One mesh on its way.
class Rider {
 public:
  Rider(const scenes::Scene& scene, const tracking::SurfaceMesh& start, const RideSettings& settings)
      : scene_(scene),
        motion_(scene),
        settings_(settings),
        method_(tracking::make_velocity_method(settings.velocity)),
        starts_(start.positions),
        topology_(tracking::build_adjacency(int(start.positions.size()), start.triangles)),
        rest_lengths_(tracking::edge_lengths(topology_, start.positions)),
        positions_(start.positions),
        moving_(motion_, Truth::motion, starts_),
        unspinning_(motion_, Truth::unspinning, starts_) {}

  Ride go() {
    Ride ride;
    ride.settings = settings_;
    for (int period = 1; period <= settings_.periods; ++period) {
      for (int i = 0; i < settings_.steps_per_period; ++i) step((period - 1) * settings_.steps_per_period + i);
      ride.checkpoints.push_back({period, moving_.errors(positions_), unspinning_.errors(positions_),
                                  edge_strain(tracking::edge_lengths(topology_, positions_), rest_lengths_), failed_,
                                  positions_});
      if (interrupted()) throw RunError("interrupted");
    }
    return ride;
  }

 private:
  double time_of(int step) const { return motion_.period() * step / settings_.steps_per_period; }

  void step(int number) {
    const double now = time_of(number), next = time_of(number + 1);
    const tracking::MetaballField field_now = motion_.field(now);
    std::vector<Vec3> velocities;
    method_->evaluate(field_now, topology_, positions_, velocities);
    moving_.add_velocities(positions_, velocities, now);
    unspinning_.add_velocities(positions_, velocities, now);
    const auto field_at = [&](double time) { return tracking::shared_field(motion_.field(time)); };
    tracking::advect_step(*method_, topology_, settings_.integrator, field_now, field_at, now, next - now, velocities,
                          positions_);
    fit_to(motion_.field(next));
    moving_.add_positions(positions_, next);
    unspinning_.add_positions(positions_, next);
  }

  // Onto the surface [FMM13, Eq. 12], with fairing [FMM13, 3.4].
  void fit_to(const tracking::MetaballField& field) {
    const tracking::ProjectionSettings projection = tracking::default_projection(field.scale());
    failed_ = int(tracking::project_to_surface(field, projection, positions_).failed.size());
    if (settings_.fairing_iterations == 0) return;
    std::vector<tracking::Confidence> confidence;
    if (settings_.variable_springs) confidence = tracking::field_confidence(field, positions_);
    tracking::fair(field, topology_, rest_lengths_, {settings_.fairing_iterations, scene_.tracking.fairing_stiffness},
                   confidence, positions_);
    failed_ = int(tracking::project_to_surface(field, projection, positions_).failed.size());
  }

  const scenes::Scene& scene_;
  MaterialMotion motion_;
  RideSettings settings_;
  std::unique_ptr<tracking::VelocityMethod> method_;
  std::vector<Vec3> starts_;
  tracking::MeshAdjacency topology_;
  std::vector<double> rest_lengths_;
  std::vector<Vec3> positions_;
  ErrorLog moving_, unspinning_;
  int failed_ = 0;
};

}  // namespace

std::string integrator_name(tracking::Integrator integrator) {
  switch (integrator) {
    case tracking::Integrator::euler:
      return "euler";
    case tracking::Integrator::rk2:
      return "rk2";
    case tracking::Integrator::rk4:
      break;
  }
  return "rk4";
}

RideSettings ride_settings(const scenes::Scene& scene) {
  const tracking::TrackerSettings tracker = scenes::settings_in_metres(scene);
  const double period = MaterialMotion(scene).period();
  RideSettings settings;
  settings.velocity = tracker.velocity;
  settings.integrator = tracker.integrator;
  settings.steps_per_period = int(std::lround(period * scene.frame_rate * scene.tracking.steps_per_frame));
  settings.periods = int(std::lround(scene.frames / scene.frame_rate / period));
  settings.fairing_iterations = tracker.fairing_iterations;
  settings.variable_springs = tracker.variable_springs;
  return settings;
}

tracking::SurfaceMesh start_mesh(const scenes::Scene& scene) {
  const tracking::MetaballField field = MaterialMotion(scene).field(0);
  tracking::SurfaceGeometry geometry = tracking::extract_surface(field, scenes::settings_in_metres(scene).edge_length);
  tracking::project_to_surface(field, tracking::default_projection(field.scale()), geometry.positions);
  tracking::SurfaceMesh mesh;
  mesh.positions = mesh.rest_positions = std::move(geometry.positions);
  mesh.triangles = std::move(geometry.triangles);
  mesh.ids.resize(mesh.positions.size());
  std::iota(mesh.ids.begin(), mesh.ids.end(), std::uint64_t{0});
  mesh.next_id = mesh.ids.size();
  return mesh;
}

Ride take_ride(const scenes::Scene& scene, const tracking::SurfaceMesh& start, const RideSettings& settings) {
  return Rider(scene, start, settings).go();
}

std::vector<Ride> take_rides(const scenes::Scene& scene, const tracking::SurfaceMesh& start,
                             const std::vector<RideSettings>& settings) {
  std::vector<Ride> rides(settings.size());
  std::vector<std::exception_ptr> errors(settings.size());
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t i = 0; i < settings.size(); ++i) {
    try {
      rides[i] = take_ride(scene, start, settings[i]);
    } catch (...) {
      errors[i] = std::current_exception();
    }
  }
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
  return rides;
}

}  // namespace flowskin::tools
