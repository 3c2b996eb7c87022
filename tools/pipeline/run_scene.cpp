#include "tools/pipeline/run_scene.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "common/errors.h"
#include "common/thread_count.h"
#include "scenes/scene_file.h"
#include "tools/pipeline/frame_loop.h"
#include "tools/pipeline/interruption.h"
#include "tools/pipeline/resume.h"
#include "tools/pipeline/run_folder.h"
#include "tools/pipeline/run_record.h"
#include "tools/pipeline/run_start.h"
#include "tools/pipeline/tracker_bridge.h"
#include "tools/report/messages.h"

namespace flowskin::tools {

namespace {

void check_can_compare(const scenes::Scene& scene, const RunOptions& options) {
  if (!methods_to_compare(options.compare).empty() && !scene.tracking.enabled)
    throw InputError(fmt::format("--compare needs a tracked surface, but {} has tracking.enabled false",
                                 options.scene_file.string()));
}

void resume_scene(scenes::Scene scene, RunOptions& options, const RunDirectory& directory) {
  std::unique_ptr<Checkpoint> checkpoint = open_checkpoint(directory);
  const RunFolder folder(directory);
  folder.check_inputs_stay(files_needed(scene, options.scene_file));
  folder.check_may_go_on();
  if (options.compare.empty()) options.compare = checkpoint->header().compare;
  check_can_compare(scene, options);
  RunStart start = start_run(std::move(scene), options);
  const CheckpointHeader now = checkpoint_header(start, options.compare);
  const std::vector<std::string> changed = check_resumable(*checkpoint, now, start.scene.frames);
  const CheckpointFolder checkpoints(directory.checkpoint_folder());
  if (checkpoints.complete_frames() == start.scene.frames) {
    if (!options.quiet)
      say_line(fmt::format("{} is complete: all {} frames are there; nothing is left to do", directory.root().string(),
                           start.scene.frames));
    return;
  }
  directory.make_folders();
  RunRecorder recorder(directory, RunRecorder::Work::whole_run);
  checkpoints.unmark_complete();
  catch_interruptions();
  FrameLoop run(options, std::move(start), directory, recorder, checkpoint.get());
  checkpoint.reset();
  run.tell_changes(changed);
  run.run();
}

void begin_scene(scenes::Scene scene, const RunOptions& options, const RunDirectory& directory) {
  const std::string name = run_name(scene, options.scene_file);
  const RunFolder folder(directory);
  folder.check_inputs_stay(files_needed(scene, options.scene_file));
  folder.check_may_begin(options, name);
  // An earlier run is removed only once it is known that this one can begin.
  RunStart start = start_run(std::move(scene), options);
  folder.clear(name);
  RunRecorder recorder(directory, RunRecorder::Work::whole_run);
  catch_interruptions();
  FrameLoop(options, std::move(start), directory, recorder, nullptr).run();
}

}  // namespace

void run_scene(const RunOptions& options) {
  RunOptions with_folder = options;
  with_folder.out_is_default = options.out.empty();
  if (options.out.empty()) with_folder.out = std::filesystem::path("output") / options.scene_file.stem();
  run_scene(scenes::read_scene(options.scene_file), with_folder);
}

void run_scene(scenes::Scene scene, const RunOptions& given) {
  RunOptions options = given;
  use_threads(options.threads);
  check_can_compare(scene, options);
  catch_hangups(options.stop_on_hangup);
  const RunDirectory directory(options.out);
  // Nothing is looked at, written or removed there without the lock.
  RunLock lock;
  if (options.resume) {
    lock.take(directory);
    return resume_scene(std::move(scene), options, directory);
  }
  lock.create(directory);
  begin_scene(std::move(scene), options, directory);
}

}  // namespace flowskin::tools
