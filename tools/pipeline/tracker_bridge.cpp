#include "tools/pipeline/tracker_bridge.h"

namespace flowskin::tools {

tracking::Particles to_particles(const scenes::ParticleState& state) {
  tracking::Particles particles;
  particles.time = state.time;
  particles.ids = state.ids;
  particles.positions = state.positions;
  if (state.has_velocities) particles.velocities = state.velocities;
  if (state.has_material) particles.rest_positions = state.rest_positions;
  particles.weights = state.weights;
  particles.has_lasting_ids = state.has_lasting_ids;
  particles.walls = state.walls;
  return particles;
}

std::string velocity_method_for(const std::string& name, const scenes::ParticleState& state) {
  if (name != kAutomaticVelocity) return name;
  return state.has_velocities ? "hybrid" : "affine";
}

double max_slip_of(const scenes::Scene& scene) {
  if (scene.tracking.max_slip >= 0) return scene.tracking.max_slip;
  return scene.particles.source == scenes::ParticlesSpec::Source::prescribed || !scene.emitters.empty() ? 1 : 0;
}

tracking::TrackerSettings tracker_settings(const scenes::Scene& scene) {
  const scenes::TrackingSpec& spec = scene.tracking;
  const double spacing = scene.particles.spacing;
  tracking::TrackerSettings settings;
  settings.spacing = spacing;
  settings.field = tracking::default_field_settings(spacing, spec.radius);
  if (spec.threshold > 0) settings.field.threshold = spec.threshold;
  settings.field.wall_share = spec.wall_share;
  settings.velocity = spec.velocity == kAutomaticVelocity ? "hybrid" : spec.velocity;
  settings.integrator = spec.integrator == "euler" ? tracking::Integrator::euler
                        : spec.integrator == "rk4" ? tracking::Integrator::rk4
                                                   : tracking::Integrator::rk2;
  settings.max_motion = spec.max_motion;
  settings.edge_length = spec.edge_length * spacing;
  settings.curvature_edges = spec.curvature_edges;
  settings.smallest_part = spec.smallest_part * spacing * spacing * spacing;
  settings.small_parts = spec.small_parts == "drop"    ? tracking::SmallParts::drop
                         : spec.small_parts == "balls" ? tracking::SmallParts::balls
                                                       : tracking::SmallParts::keep;
  settings.fairing_iterations = spec.fairing_iterations;
  settings.fairing_stiffness = spec.fairing_stiffness;
  settings.variable_springs = spec.fairing_springs == "variable";
  settings.remeshing = spec.remeshing;
  settings.max_slip = max_slip_of(scene) * spacing;
  settings.topology = spec.topology;
  settings.guard = spec.guard;
  return settings;
}

std::vector<Vec2f> confidence_attribute(const tracking::Tracker& tracker) {
  std::vector<Vec2f> attribute;
  for (const tracking::Confidence& confidence : tracker.confidence())
    attribute.emplace_back(float(confidence.weak), float(confidence.strong));
  return attribute;
}

scenes::SceneVocabulary scene_vocabulary() {
  scenes::SceneVocabulary vocabulary;
  vocabulary.velocity_methods.push_back(kAutomaticVelocity);
  for (const auto& method : tracking::velocity_methods()) vocabulary.velocity_methods.push_back(method.name);
  return vocabulary;
}

}  // namespace flowskin::tools
