// The truth that velocity methods are measured against: markers, and the flow that they ride.
#pragma once

#include <optional>
#include <string>
#include <type_traits>

#include "common/state_archive.h"
#include "scenes/scene.h"
#include "scenes/sources/motion.h"
#include "tracking/ground_truth/markers.h"
#include "tracking/tracker.h"

namespace flowskin::tools {

/// How the markers are set out and moved.
struct MarkerSettings {
  int most = 20000;       ///< Every second, third, ... vertex of the first mesh gets one where it has more vertices.
  double most_depth = 1;  ///< A marker farther from f = 0 than this (spacings) has left the surface.
  /// Of their Runge-Kutta steps: no particle moves further than this share of the effective radius in one, and with a
  /// prescribed rotation none turns further than this angle (rad). Steps five times as fine change no error of the
  /// stairs' preview by more than 0.001 spacings.
  double step = 0.25, step_angle = 0.02;
  int most_steps = 1000;  ///< Between two states of the particles.
};

/// With prescribed motion the flow is known exactly; else it is that of the particles, by moving least squares.
class GroundTruth {
 public:
  /// `start` are the particles at the start of the run.
  GroundTruth(const scenes::Scene& scene, tracking::TrackerSettings settings, tracking::Particles start,
              const MarkerSettings& markers = {});

  /// Puts markers onto the mesh, where there are none yet. Call it with the mesh at the present time.
  void start_markers(const tracking::SurfaceMesh& mesh);
  /// Carries the markers to the time of these particles.
  void advance(const tracking::Particles& particles);

  const tracking::Markers& markers() const { return markers_; }
  const tracking::Particles& particles() const { return particles_; }
  /// Field and flow at the present time.
  tracking::MetaballField field() const;
  tracking::Flow flow() const;
  /// In words, such as "the prescribed motion".
  std::string description() const;

  template <class Archive>
  void visit(Archive& archive) {
    archive.section("markers");
    tracking::visit_state(archive, particles_);
    archive(markers_);
    if constexpr (std::is_same_v<Archive, StateReader>) check_restored();
  }

 private:
  /// @throws StateError, std::invalid_argument
  void check_restored() const;
  tracking::FlowAt exact_flow() const;
  int exact_steps(double duration) const;
  int steps_for(double ratio) const;

  std::optional<scenes::Motion> motion_;  // prescribed
  tracking::TrackerSettings settings_;
  MarkerSettings marker_settings_;
  double most_depth_;              // m
  tracking::Particles particles_;  // at the present time
  tracking::Markers markers_;
};

}  // namespace flowskin::tools
