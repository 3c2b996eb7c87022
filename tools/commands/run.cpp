// flowskin run SCENE: from the scene to its run directory.
#include <memory>

#include "tools/commands/shared_options.h"
#include "tools/pipeline/run_scene.h"

namespace flowskin::tools {

Command run_command() {
  struct Chosen {
    RunOptions run;
    PictureFlags pictures;
  };
  const auto chosen = std::make_shared<Chosen>();
  RunOptions& run = chosen->run;
  const std::vector<Option> options{
      {"scene", &run.scene_file, "Scene file (JSON); see docs/scenes.md", {.is_required = true}},
      {"--out", &run.out, "Run directory (default: output/<name of the scene file>); see --overwrite"},
      {"--frames", &run.frames, "Number of frames after the first (default: the scene's)", {.range = {{0, 1000000}}}},
      velocity_option(run.velocity, "the scene's"),
      {"--compare", &run.compare,
       "Carry one mesh for each of these velocity methods (comma separated, or all) and measure their errors; with "
       "settings of its own: hybrid:fairing=0:integrator=rk4; see docs/compare.md"},
      threads_option(run.threads),
      {"--resume", &run.resume,
       "Go on from the last checkpoint in the run directory, as if the run had never stopped; see docs/restart.md"},
      overwrite_option(run),
      hangup_option(run),
      chosen->pictures.pictures_option(),
      chosen->pictures.video_option(),
      {"--quiet", &run.quiet, "No progress; warnings and errors only"},
  };
  return {"run", "Run a scene: simulate, track the surface, write meshes, pictures and videos", options,
          [chosen](const std::string& command_line) {
            chosen->run.command_line = command_line;
            chosen->pictures.apply(chosen->run);
            run_scene(chosen->run);
            return 0;
          }};
}

}  // namespace flowskin::tools
