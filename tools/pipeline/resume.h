// Whether a run may be gone on with: the scene must be the one that was run, but for what the past does not depend on.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tools/pipeline/checkpoint.h"
#include "tools/pipeline/run_directory.h"

namespace flowskin::tools {

/// The newest checkpoint of a run directory.
/// @throws InputError where there is none, saying why, or it is damaged.
std::unique_ptr<Checkpoint> open_checkpoint(const RunDirectory& directory);

/// Keys in which two scenes, as written by write_scene, differ, in the order of the second.
struct SceneChanges {
  std::vector<std::string> forbidden;  ///< Such as "fluid.viscosity".
  /// Numerical limits of the solver that a blow-up may ask for, such as "simulation.max_speed: 2, now 4".
  std::vector<std::string> numerical;
};
SceneChanges scene_changes(const std::string& then, const std::string& now);

/// Checks that a run of this scene may go on from the checkpoint; returns the numerical settings that have changed.
/// @param now the header that a checkpoint of the new run would have
/// @param frames of the new run
/// @throws InputError naming what differs.
std::vector<std::string> check_resumable(const Checkpoint& checkpoint, const CheckpointHeader& now, int frames);

}  // namespace flowskin::tools
