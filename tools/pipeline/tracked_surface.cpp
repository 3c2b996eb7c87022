#include "tools/pipeline/tracked_surface.h"

#include <fmt/format.h>

#include <cmath>

#include "tools/pipeline/frame_writer.h"

namespace flowskin::tools {

namespace {

/// Of blended states, in effective radii: beyond it they show the fluid twice.
constexpr double kLargestMismatch = 0.5;

}  // namespace

TrackedSurface::TrackedSurface(const scenes::Scene& scene, const scenes::ParticleState& start)
    : scene_(scene),
      tracker_(scenes::settings_in_metres(scene), to_particles(start)),
      textures_(scene.texture, rest_frame_of(scene.texture)) {}

tracking::Particles TrackedSurface::with_textures(const scenes::ParticleState& state) {
  tracking::Particles particles = to_particles(state);
  textures_.carry(particles);
  return particles;
}

std::string TrackedSurface::warning() {
  const tracking::TrackerReport& report = tracker_.report();
  const double largest = kLargestMismatch * tracker_.settings().field.radius;
  if (warned_of_ghosts_ || !report.blended || report.mismatch <= largest) return "";
  warned_of_ghosts_ = true;
  return fmt::format(
      "at {:.4g} s particles are up to {:.3g} m from any of the state before, more than half the effective radius "
      "({:.3g} m), and it is not known which is which: the surface between the two states shows the fluid twice. "
      "Record at least {} times as many frames, write ids or velocities with the particles, or take a larger --radius",
      tracker_.state().particles.time, report.mismatch, tracker_.settings().field.radius,
      std::ceil(report.mismatch / largest));
}

SurfaceFrame TrackedSurface::frame(const scenes::ParticleState& state, double duration, double time) {
  textures_.update(tracker_, to_particles(state), duration);
  SurfaceFrame frame = textures_.dress(tracker_.mesh(), time);
  frame.texture_file = FrameWriter::kTextureFile;
  if (scene_.tracking.confidence || scene_.render.style == "confidence")
    frame.confidence = confidence_attribute(tracker_);
  return frame;
}

}  // namespace flowskin::tools
