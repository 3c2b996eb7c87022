#include "tools/pipeline/run_scene.h"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <utility>

#include "common/errors.h"
#include "common/thread_count.h"
#include "scenes/scene_file.h"
#include "tools/pipeline/frame_loop.h"
#include "tools/pipeline/interruption.h"
#include "tools/pipeline/resume.h"
#include "tools/pipeline/run_start.h"
#include "tools/pipeline/tracker_bridge.h"

namespace flowskin::tools {

namespace {

void resume_scene(scenes::Scene scene, RunOptions& options, const RunDirectory& directory) {
  std::unique_ptr<Checkpoint> checkpoint = open_checkpoint(directory);
  if (options.compare.empty()) options.compare = checkpoint->header().compare;
  RunStart start = start_run(std::move(scene), options);
  const CheckpointHeader now = checkpoint_header(start, options.compare);
  const std::vector<std::string> changed = check_resumable(*checkpoint, now, start.scene.frames);
  const CheckpointFolder checkpoints(directory.checkpoint_folder());
  if (checkpoints.complete_frames() == start.scene.frames) {
    if (!options.quiet)
      fmt::print(stderr, "{} is complete: all {} frames are there; nothing is left to do\n", directory.root().string(),
                 start.scene.frames);
    return;
  }
  directory.prepare_to_resume();
  checkpoints.unmark_complete();
  catch_interruptions();
  FrameLoop run(options, std::move(start), directory, checkpoint.get());
  checkpoint.reset();
  run.tell_changes(changed);
  run.run();
}

}  // namespace

void run_scene(const RunOptions& options) {
  RunOptions with_folder = options;
  if (options.out.empty()) with_folder.out = std::filesystem::path("output") / options.scene_file.stem();
  run_scene(scenes::read_scene(options.scene_file), with_folder);
}

void run_scene(scenes::Scene scene, const RunOptions& given) {
  RunOptions options = given;
  use_threads(options.threads);
  if (!methods_to_compare(options.compare).empty() && !scene.tracking.enabled)
    throw InputError(fmt::format("--compare needs a tracked surface, but {} has tracking.enabled false",
                                 options.scene_file.string()));
  const RunDirectory directory(options.out);
  check_inputs_stay(scene, directory);
  RunLock lock;
  lock.take(directory);
  if (options.resume) return resume_scene(std::move(scene), options, directory);
  // An earlier run is removed only once it is known that this one can begin.
  RunStart start = start_run(std::move(scene), options);
  directory.prepare();
  lock.take(directory);
  catch_interruptions();
  FrameLoop(options, std::move(start), directory, nullptr).run();
}

}  // namespace flowskin::tools
