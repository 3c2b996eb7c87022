// What happens before the first frame of a run: the scene as it is run, and its particles.
#pragma once

#include <memory>

#include "scenes/scene.h"
#include "scenes/sources/particle_source.h"
#include "tools/pipeline/run_directory.h"
#include "tools/pipeline/run_options.h"

namespace flowskin::tools {

struct RunStart {
  scenes::Scene scene;  ///< With the options of the command line, and all automatic values filled in.
  std::unique_ptr<scenes::ParticleSource> source;
  double seconds = 0;  ///< It took to make the source.
};

/// @throws InputError where the scene does not fit its particles.
RunStart start_run(scenes::Scene scene, const RunOptions& options);

/// @throws InputError where the run would remove the particles that it is to read.
void check_inputs_stay(const scenes::Scene& scene, const RunDirectory& directory);

}  // namespace flowskin::tools
