// The numbers of frames.csv, gathered over the tracker steps of a frame.
#pragma once

#include <cstdint>
#include <string>
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
  FrameRow finish_frame(int frame, const scenes::ParticleSource& source, const tracking::Tracker* tracker,
                        const SurfaceFrame* surface);

  /// Why the whole mesh was replaced last.
  const std::string& last_reason() const { return last_reason_; }
  int frames_reextracted() const { return frames_reextracted_; }

 private:
  int substeps_ = 0, reextractions_ = 0, frames_reextracted_ = 0;
  int splits_ = 0, collapses_ = 0, flips_ = 0, regions_ = 0;
  double seconds_topology_ = 0;
  std::string last_reason_;
  std::vector<std::uint64_t> previous_ids_;  // ascending
};

}  // namespace flowskin::tools
