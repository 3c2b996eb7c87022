// The truth that velocity methods are measured against: markers, and the flow that they ride.
#pragma once

#include <optional>
#include <string>

#include "scenes/scene.h"
#include "scenes/sources/motion.h"
#include "tracking/ground_truth/markers.h"
#include "tracking/tracker.h"

namespace flowskin::tools {

/// With prescribed motion the flow is known exactly; else it is that of the particles, by moving least squares.
class GroundTruth {
 public:
  static constexpr int kMostMarkers = 20000;
  static constexpr double kMostDepthInSpacings = 1;  ///< A marker that is farther from f = 0 has left the surface.

  /// `start` are the particles at the start of the run.
  GroundTruth(const scenes::Scene& scene, tracking::TrackerSettings settings, tracking::Particles start);

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
  }

 private:
  tracking::FlowAt exact_flow() const;
  int exact_steps(double duration) const;

  std::optional<scenes::Motion> motion_;  // prescribed
  tracking::TrackerSettings settings_;
  double most_depth_;
  tracking::Particles particles_;  // at the present time
  tracking::Markers markers_;
};

}  // namespace flowskin::tools
