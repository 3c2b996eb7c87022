// The surface that a run tracks, and the textures on it.
#pragma once

#include <string>

#include "scenes/scene.h"
#include "tools/frame_data.h"
#include "tools/pipeline/tracker_bridge.h"
#include "tools/textures/texture_generations.h"
#include "tracking/tracker.h"

namespace flowskin::tools {

class TrackedSurface {
 public:
  /// Extracts the first mesh. @param scene must outlive this
  TrackedSurface(const scenes::Scene& scene, const scenes::ParticleState& start);

  /// The particles as trackers take them, with their places in the generations of the texture.
  tracking::Particles with_textures(const scenes::ParticleState& state);
  /// Carries the mesh to these particles.
  void advance(const tracking::Particles& particles) { tracker_.advance(particles); }
  /// What is to be warned of after the last step, once a run: blended states that show the fluid twice. Empty: nothing.
  std::string warning();
  /// The surface as it is written and drawn, its textures moved on by `duration` (s).
  /// @param time of the frame (s)
  SurfaceFrame frame(const scenes::ParticleState& state, double duration, double time);

  const tracking::Tracker& tracker() const { return tracker_; }
  const TextureGenerations& textures() const { return textures_; }

  template <class Archive>
  void visit(Archive& archive) {
    archive(textures_, warned_of_ghosts_);
    visit_tracker(archive, tracker_);
    if (!textures_.fit(tracker_.mesh())) throw StateError("the saved textures do not fit the surface");
  }

 private:
  const scenes::Scene& scene_;
  tracking::Tracker tracker_;
  TextureGenerations textures_;
  bool warned_of_ghosts_ = false;
};

}  // namespace flowskin::tools
