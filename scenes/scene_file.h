// Reads and writes scene files: JSON with comments, checked key by key.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace flowskin::scenes {

/// One key of the scene file, for documentation and for `flowskin scene --keys`.
struct SceneKey {
  std::string path;           ///< such as "fluid.viscosity" or "bodies[].radius"
  std::string type;           ///< such as "number", "3 numbers", "one of: box, planar, spherical"
  std::string unit;           ///< such as "m^2/s", "spacings", or "" for none
  std::string default_value;  ///< as JSON; "required" where there is none
  std::string meaning;        ///< one sentence
};

/// @throws InputError naming the file, the key and its place (line), what was expected and, for an unknown key or
/// value, the nearest valid one. Meshes that the scene names are read and placed.
Scene read_scene(const std::filesystem::path& file);
/// The same from text; `name` stands for the file in messages, `directory` is where relative names start.
Scene parse_scene(const std::string& text, const std::string& name, const std::filesystem::path& directory);
/// The scene with every key written out, readable by read_scene; file names are written absolute, so that the file can
/// stand anywhere.
std::string write_scene(const Scene& scene);
/// All keys in the order of the file.
std::vector<SceneKey> scene_keys();

}  // namespace flowskin::scenes
