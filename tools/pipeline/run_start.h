// What happens before the first frame of a run: the scene as it is run, and its particles.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "scenes/sources/particle_source.h"
#include "tools/pipeline/checkpoint.h"
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

/// All files that the run is made from: the scene, meshes, the texture, recorded particles.
/// @param scene_file may be empty. @throws InputError where there are no recorded particles
std::vector<std::filesystem::path> files_needed(const scenes::Scene& scene, const std::filesystem::path& scene_file);

/// What the record of a run directory calls this run: the scene file, or what is tracked.
std::string run_name(const scenes::Scene& scene, const std::filesystem::path& scene_file);

}  // namespace flowskin::tools
