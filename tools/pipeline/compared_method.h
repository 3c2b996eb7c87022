// What `--compare` compares: velocity methods, each with settings of its own where the user gives some.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "scenes/scene.h"
#include "tracking/tracker.h"

namespace flowskin::tools {

struct ComparedMethod {
  std::string name;      ///< As the user wrote it: it stands in tables, plots and pictures.
  std::string velocity;  ///< The velocity method.
  std::vector<std::pair<std::string, std::string>> settings;  ///< Keys of the scene's `tracking`, and their values.
};

/// Of `--compare NAME[:KEY=VALUE]...,...`, none for an empty text: "all" stands for all methods but those that only
/// check another one (curvature-belyaev); one named twice counts once. "fairing" is short for "fairing_iterations".
/// @throws InputError naming the valid ones, where a name, a key or a value is unknown, or where a key would give
/// another surface instead of another way to carry it.
std::vector<ComparedMethod> methods_to_compare(const std::string& list);

/// The scene's settings with those of the method, and with a texture that slips freely: one that is held on the
/// particles would show what they do, not what the method does.
tracking::TrackerSettings settings_for(const scenes::Scene& scene, const ComparedMethod& method);

}  // namespace flowskin::tools
