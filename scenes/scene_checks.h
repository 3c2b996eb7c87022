// What no single key can tell: keys that contradict each other, and the files that a scene names.
#pragma once

#include "scenes/scene.h"
#include "scenes/schema/objects.h"

namespace flowskin::scenes {

/// Reports contradictions in a scene whose keys were all read without a problem; `root` is its text as a tree.
void check_consistency(const Scene& scene, const JsonNode& root, Problems& problems);

/// Reads and places the meshes that the scene names, and checks that its image exists.
void load_files(Scene& scene, const JsonNode& root, Problems& problems);

/// @throws InputError where it cannot be found
std::string current_folder();

/// A file name of the scene as an absolute path.
std::string absolute_name(const std::string& directory, const std::string& file);

}  // namespace flowskin::scenes
