// One run, frame by frame: the order of the data from top to bottom.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "scenes/sources/particle_source.h"
#include "tools/pipeline/checkpoint.h"
#include "tools/pipeline/comparison.h"
#include "tools/pipeline/frame_statistics.h"
#include "tools/pipeline/frame_writer.h"
#include "tools/pipeline/picture_maker.h"
#include "tools/pipeline/run_directory.h"
#include "tools/pipeline/run_options.h"
#include "tools/pipeline/run_start.h"
#include "tools/pipeline/tracker_bridge.h"
#include "tools/report/frames_csv.h"
#include "tools/report/progress.h"
#include "tools/report/run_log.h"
#include "tools/report/stage_clock.h"
#include "tools/textures/texture_generations.h"
#include "tools/textures/texture_mapping.h"

namespace flowskin::tools {

/// The state of one run; advance() and record() do the work of one frame, in the order of the data.
class SceneRun {
 public:
  /// @param resumed the checkpoint that the run goes on from; null: from the start. Is looked at here only.
  /// @throws InputError where the checkpoint does not fit; RunError where files cannot be written
  SceneRun(const RunOptions& options, RunStart start, const RunDirectory& directory, Checkpoint* resumed);

  /// Settings that differ from those of the run that is resumed.
  void tell_changes(const std::vector<std::string>& changes) {
    for (const std::string& change : changes) log_.info("changed since the checkpoint: " + change);
  }
  /// @throws InterruptedError, RunError: what was written until then stays valid
  void run();

 private:
  /// All that the next frame depends on but the scene, and what the end tells of the whole run.
  template <class Archive>
  void visit(Archive& archive) {
    archive.section("run");
    archive(frame_, steps_done_, elapsed_, clock_, booked_, rows_, statistics_, *writer_, *generations_);
    archive(warned_of_ghosts_);
    if (tracker_) visit_tracker(archive, *tracker_);
    if (comparison_) archive(*comparison_);
  }
  CheckpointHeader header() const;
  void save_checkpoint();
  void save_regularly();
  void restore(Checkpoint& checkpoint);

  void start_comparison();
  void describe();
  void go_through_frames(Progress& progress);
  void advance();
  void record(int frame);
  void warn_of_ghosts(double time);
  void write_row(int frame, std::size_t particles, const SurfaceFrame* surface);
  void finish();
  void report_times();
  [[noreturn]] void stop();
  std::string what_is_kept() const;

  const RunOptions& options_;
  scenes::Scene scene_;
  const RunDirectory& directory_;
  CheckpointFolder checkpoints_;
  RunLog log_;
  StageClock clock_;
  std::unique_ptr<scenes::ParticleSource> source_;
  RestFrame rest_;
  Image texture_;
  std::unique_ptr<tracking::Tracker> tracker_;
  std::unique_ptr<TextureGenerations> generations_;
  std::unique_ptr<FrameWriter> writer_;
  std::unique_ptr<PictureMaker> pictures_;
  std::unique_ptr<Comparison> comparison_;
  FrameStatistics statistics_;
  std::vector<FrameRow> rows_;
  int frame_ = 0, steps_done_ = 0;  // the frame that is worked on, and the tracker's steps to it that are done
  int saved_ = -1;                  // frame of the last checkpoint
  bool warned_of_ghosts_ = false;
  double began_ = wall_seconds(), elapsed_ = 0;  // elapsed_: before began_, or at the time of a checkpoint
  std::map<std::string, double> booked_;         // seconds of each stage up to the last row
};

}  // namespace flowskin::tools
