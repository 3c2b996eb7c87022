// Runs a scene end to end: particles -> tracker -> files -> pictures -> report.
#pragma once

#include "scenes/scene.h"
#include "tools/pipeline/run_options.h"

namespace flowskin::tools {

/// Runs the scene into its run directory.
/// @throws InputError, sph::SettingsError where the input is wrong; RunError, sph::BlowUpError
/// where the run fails: what was written until then stays valid.
void run_scene(const RunOptions& options);
/// The same with a scene in memory; options.scene_file is not looked at, options.out must be given.
void run_scene(scenes::Scene scene, const RunOptions& options);

}  // namespace flowskin::tools
