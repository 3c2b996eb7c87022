// Runs a scene end to end: particles -> tracker -> files -> pictures -> report.
#pragma once

#include "tools/pipeline/run_options.h"

namespace flowskin::tools {

/// Runs the scene into its run directory.
/// @throws InputError, scenes::SceneError, sph::SettingsError where the input is wrong; RunError, sph::BlowUpError
/// where the run fails: what was written until then stays valid.
void run_scene(const RunOptions& options);

}  // namespace flowskin::tools
