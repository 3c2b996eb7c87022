// frames.csv as it grows, a row a frame.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scenes/sources/particle_source.h"
#include "tools/frame_data.h"
#include "tools/pipeline/frame_statistics.h"
#include "tools/pipeline/tracked_surface.h"
#include "tools/pipeline/volume_outside_walls.h"
#include "tools/report/frames_csv.h"
#include "tools/report/stage_clock.h"

namespace flowskin::tools {

class FrameTable {
 public:
  /// @param walls of the scene @param checks which frames are compared with a fresh extraction @param clock whose times
  /// of each frame go into its row
  FrameTable(std::filesystem::path file, WallSolids walls, scenes::Checks checks, StageClock& clock)
      : file_(std::move(file)), walls_(std::move(walls)), checks_(checks), clock_(clock) {}

  /// Adds what happened in one tracker step.
  void add_step(const tracking::TrackerReport& report) { statistics_.add(report); }
  /// Measures the frame that ends now, and writes the whole table.
  /// @param particles how many are written; @param surface, shown: null where no surface is tracked. @throws RunError
  const FrameRow& add_frame(int frame, const scenes::ParticleSource& source, std::size_t particles,
                            const TrackedSurface* surface, const SurfaceFrame* shown);

  /// Takes back the last row: its frame could not be written.
  void drop_frame() { rows_.pop_back(); }

  const std::vector<FrameRow>& rows() const { return rows_; }
  const FrameStatistics& statistics() const { return statistics_; }

  template <class Archive>
  void visit(Archive& archive) {
    archive(booked_, rows_, statistics_);
  }

 private:
  double since_last_row(const char* stage);
  bool is_checked(int frame) const;

  std::filesystem::path file_;
  WallSolids walls_;
  scenes::Checks checks_;
  StageClock& clock_;
  FrameStatistics statistics_;
  std::vector<FrameRow> rows_;
  std::map<std::string, double> booked_;  // seconds of each stage up to the last row
};

}  // namespace flowskin::tools
