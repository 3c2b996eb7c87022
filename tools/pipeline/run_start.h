// What happens before the first frame of a run: the scene as it is run, and its particles.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "scenes/sources/particle_source.h"
#include "tools/pipeline/checkpoint.h"
#include "tools/pipeline/run_directory.h"
#include "tools/pipeline/run_options.h"
#include "tools/textures/image.h"

namespace flowskin::tools {

struct RunStart {
  scenes::Scene scene;  ///< With the options of the command line, and all automatic values filled in.
  std::unique_ptr<scenes::ParticleSource> source;
  Image texture;
  std::vector<FileContent> files;  ///< What was in the files that the scene names.
  double seconds = 0;              ///< It took to make the source.
};

/// @throws InputError where the scene does not fit its particles.
RunStart start_run(scenes::Scene scene, const RunOptions& options);

/// What the checkpoints of this run say of it, all but the frame. @param compare the methods compared
CheckpointHeader checkpoint_header(const RunStart& start, const std::string& compare);

/// @throws InputError where the run would remove the particles that it is to read.
void check_inputs_stay(const scenes::Scene& scene, const RunDirectory& directory);

}  // namespace flowskin::tools
