#include "scenes/settings_in_metres.h"

namespace flowskin::scenes {
namespace {

/// Whether fairing carries the material along. Where it does not, the errors of a rough velocity add up in the rest
/// positions unsmoothed, and the texture becomes noise.
bool fairing_drags(FairingMaterial material, const std::string& velocity) {
  if (material != FairingMaterial::automatic) return material == FairingMaterial::dragged;
  return velocity != "hybrid" && velocity != "simulation" && velocity != "affine";
}

}  // namespace

tracking::TrackerSettings settings_in_metres(const Scene& scene) {
  const double spacing = scene.particles.spacing;
  tracking::TrackerSettings settings = scene.tracking;
  settings.spacing = spacing;
  const tracking::FieldSettings field = tracking::default_field_settings(spacing, scene.tracking.field.radius);
  settings.field.radius = field.radius;
  settings.field.weight = field.weight;
  settings.field.threshold = scene.tracking.field.threshold > 0 ? scene.tracking.field.threshold : field.threshold;
  if (settings.velocity == automatic_velocity) settings.velocity = "hybrid";
  settings.fairing_drags = fairing_drags(scene.tracking.fairing_material, settings.velocity);
  settings.edge_length *= spacing;
  settings.smallest_part = settings.smallest_part * spacing * spacing * spacing;
  settings.max_slip = max_slip_of(scene) * spacing;
  return settings;
}

double max_slip_of(const Scene& scene) {
  if (scene.tracking.max_slip >= 0) return scene.tracking.max_slip;
  return scene.particles.source == ParticlesSpec::Source::prescribed || !scene.emitters.empty() ? 1 : 0;
}

std::string velocity_method_for(const std::string& name, const ParticleState& state) {
  if (name != automatic_velocity) return name;
  return state.has_velocities ? "hybrid" : "affine";
}

}  // namespace flowskin::scenes
