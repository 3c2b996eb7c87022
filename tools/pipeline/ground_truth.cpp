#include "tools/pipeline/ground_truth.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tracking/advection/particle_paths.h"

namespace flowskin::tools {

GroundTruth::GroundTruth(const scenes::Scene& scene, tracking::TrackerSettings settings, tracking::Particles start,
                         const MarkerSettings& markers)
    : settings_(std::move(settings)),
      marker_settings_(markers),
      most_depth_(markers.most_depth * scene.particles.spacing),
      particles_(std::move(start)) {
  if (scene.particles.source == scenes::ParticlesSpec::Source::prescribed) motion_.emplace(scene.particles.motion);
}

void GroundTruth::start_markers(const tracking::SurfaceMesh& mesh) {
  if (!markers_.ids.empty() || mesh.positions.empty()) return;
  markers_ = tracking::start_markers(mesh, particles_.time, marker_settings_.most);
  tracking::settle_markers(field(), most_depth_, markers_);
}

void GroundTruth::check_restored() const {
  tracking::check_particles(particles_);
  const std::size_t count = markers_.ids.size();
  const auto is_finite = [](const tracking::Vec3& v) { return v.allFinite(); };
  if (markers_.rest_positions.size() != count || markers_.positions.size() != count ||
      markers_.normals.size() != count || markers_.depths.size() != count || markers_.left.size() != count ||
      !std::all_of(markers_.positions.begin(), markers_.positions.end(), is_finite) || !std::isfinite(markers_.time))
    throw StateError("the saved markers contradict themselves");
}

tracking::MetaballField GroundTruth::field() const { return tracking::field_of(particles_, settings_.field); }

tracking::FlowAt GroundTruth::exact_flow() const {
  return [this](double time) -> tracking::Flow {
    return [this, time](const tracking::Vec3& x) { return motion_->velocity(x, time); };
  };
}

tracking::Flow GroundTruth::flow() const {
  return motion_ ? exact_flow()(particles_.time) : tracking::particle_flow(field());
}

int GroundTruth::steps_for(double ratio) const {
  return static_cast<int>(std::clamp(std::ceil(ratio), 1.0, double(marker_settings_.most_steps)));
}

int GroundTruth::exact_steps(double duration) const {
  const double turned = duration * motion_->spec().angular_velocity.norm();
  return steps_for(std::max(duration / motion_->integration_step(), turned / marker_settings_.step_angle));
}

void GroundTruth::advance(const tracking::Particles& particles) {
  if (!markers_.ids.empty() && particles.time != particles_.time) {
    const tracking::ParticlePaths paths(particles_, particles, settings_.spacing);
    if (motion_) {
      tracking::advect_markers(exact_flow(), particles.time, exact_steps(particles.time - particles_.time), markers_);
    } else {
      tracking::advect_markers(tracking::particle_flow(paths, settings_.field), particles.time,
                               steps_for(paths.longest_path() / (marker_settings_.step * settings_.field.radius)),
                               markers_);
    }
  }
  particles_ = particles;
  if (!markers_.ids.empty()) tracking::settle_markers(field(), most_depth_, markers_);
}

std::string GroundTruth::description() const {
  return motion_ ? "the prescribed motion, which is known exactly" : "the particles' velocities (moving least squares)";
}

}  // namespace flowskin::tools
