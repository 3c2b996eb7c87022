// One run, frame by frame: the order of the data from top to bottom.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "scenes/sources/particle_source.h"
#include "tools/pipeline/comparison.h"
#include "tools/pipeline/frame_output.h"
#include "tools/pipeline/frame_table.h"
#include "tools/pipeline/run_checkpoints.h"
#include "tools/pipeline/run_directory.h"
#include "tools/pipeline/run_options.h"
#include "tools/pipeline/run_record.h"
#include "tools/pipeline/run_start.h"
#include "tools/pipeline/tracked_surface.h"
#include "tools/report/progress.h"
#include "tools/report/run_clock.h"
#include "tools/report/run_log.h"

namespace flowskin::tools {

/// Carries a run from frame to frame: advance() and record() do the work of one.
class FrameLoop {
 public:
  /// @param recorder is told when the run is done
  /// @param resumed the checkpoint that the run goes on from; null: from the start. Is looked at here only.
  /// @throws InputError where the checkpoint does not fit; RunError where files cannot be written
  FrameLoop(const RunOptions& options, RunStart start, const RunDirectory& directory, RunRecorder& recorder,
            Checkpoint* resumed);

  /// Settings that differ from those of the run that is resumed.
  void tell_changes(const std::vector<std::string>& changes) {
    for (const std::string& change : changes) log_.info("changed since the checkpoint: " + change);
  }
  /// @throws InterruptedError, RunError: what was written until then stays valid
  void run();

 private:
  /// All that the next frame depends on but the scene and the source, and what the end tells of the whole run.
  template <class Archive>
  void visit(Archive& archive) {
    archive.section("run");
    archive(frame_, steps_done_, clock_, table_, output_);
    if (surface_) archive(*surface_);
    if (comparison_) archive(*comparison_);
  }

  void track_first_state();
  void check_restored(int last_frame) const;
  void go_through_frames(Progress& progress);
  void advance();
  void step_to(double time);
  void record();
  void doubt_first_surface();
  bool is_to_pause() const;
  void pause();
  void save();
  void save_regularly();
  void try_to_save();
  [[noreturn]] void stop();
  [[noreturn]] void fail(const std::exception& error);
  std::string what_is_kept() const;
  void finish();
  void require_surface();

  const TrackedSurface* surface() const { return surface_ ? &*surface_ : nullptr; }

  const RunOptions& options_;
  const RunDirectory& directory_;
  RunRecorder& recorder_;
  RunLog log_;
  RunClock clock_;
  RunCheckpoints checkpoints_;
  scenes::Scene scene_;
  std::unique_ptr<scenes::ParticleSource> source_;
  std::optional<TrackedSurface> surface_;  // none: none is tracked
  std::unique_ptr<Comparison> comparison_;
  FrameOutput output_;
  FrameTable table_;
  int frame_ = 0, steps_done_ = 0;  // the frame that is worked on, and the tracker's steps to it that are done
};

}  // namespace flowskin::tools
