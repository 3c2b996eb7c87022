// When a run saves its state, and what is said of it.
#pragma once

#include <functional>
#include <string>
#include <utility>

#include "tools/pipeline/checkpoint.h"
#include "tools/pipeline/run_directory.h"

namespace flowskin::tools {

/// The checkpoints of one run.
class RunCheckpoints {
 public:
  /// @param header of all of them, but for the frame
  /// @param interval frames from one to the next; 0: there is none
  RunCheckpoints(const RunDirectory& directory, CheckpointHeader header, int interval)
      : folder_(directory.checkpoint_folder()), header_(std::move(header)), interval_(interval) {}

  bool are_wanted() const { return interval_ > 0; }
  /// Whether one is due after this frame of so many.
  bool is_due(int frame, int frames) const {
    return are_wanted() && frame > 0 && (frame % interval_ == 0 || frame == frames);
  }
  /// @param frame the last one that is done. @throws RunError; older ones are still there then.
  void save(int frame, const std::function<void(StateWriter&)>& state);
  /// The run goes on from this one. @param state reads it. @throws InputError where it does not fit.
  void resume(Checkpoint& checkpoint, const std::function<void(StateReader&)>& state);
  /// Frame of the last one; -1: there is none.
  int saved() const { return saved_; }
  /// All is done, videos included. Only where the last frame is saved can it be gone on with.
  void mark_complete(int frames) const {
    if (saved_ == frames) folder_.mark_complete(frames);
  }

 private:
  CheckpointFolder folder_;
  CheckpointHeader header_;
  int interval_;
  int saved_ = -1;
};

}  // namespace flowskin::tools
