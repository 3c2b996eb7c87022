// The numbers of frames.csv, gathered over the tracker steps of a frame.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "scenes/sources/particle_source.h"
#include "tools/frame_data.h"
#include "tools/report/frames_csv.h"
#include "tracking/tracker.h"

namespace flowskin::tools {

class FrameStatistics {
 public:
  /// Adds what happened in one tracker step.
  void add(const tracking::TrackerReport& report);
  /// The row of the frame that ends now. `tracker` and `surface` are null where no surface is tracked.
  /// @param is_checked whether the surface is compared with a fresh extraction
  FrameRow finish_frame(int frame, const scenes::ParticleSource& source, const tracking::Tracker* tracker,
                        const SurfaceFrame* surface, bool is_checked);

  /// Why the whole mesh was replaced last.
  const std::string& last_reason() const { return last_reason_; }
  int frames_reextracted() const { return frames_reextracted_; }
  /// Of the tracker's steps by stage, since the start.
  const std::vector<std::pair<std::string, double>>& tracking_seconds() const { return tracking_seconds_; }

  template <class Archive>
  void visit(Archive& archive) {
    archive.section("statistics");
    archive(substeps_, reextractions_, frames_reextracted_, splits_, collapses_, flips_, regions_, seconds_topology_);
    const std::size_t stages = tracking_seconds_.size();
    archive(last_reason_, previous_ids_, first_ids_, tracking_seconds_);
    if (tracking_seconds_.size() != stages) throw StateError("the saved statistics have other stages");
  }

 private:
  int substeps_ = 0, reextractions_ = 0, frames_reextracted_ = 0;
  int splits_ = 0, collapses_ = 0, flips_ = 0, regions_ = 0;
  double seconds_topology_ = 0;
  std::string last_reason_;
  std::vector<std::uint64_t> previous_ids_, first_ids_;  // ascending; of the first frame that has a surface
  std::vector<std::pair<std::string, double>> tracking_seconds_{
      {"velocity", 0}, {"projection", 0}, {"fairing", 0}, {"topology", 0}};
};

}  // namespace flowskin::tools
