// Reads and writes scene files: JSON with comments, checked key by key.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "scenes/schema/scene_key.h"

namespace flowskin::scenes {

/// @throws InputError naming the file, the key and its place (line), what was expected and, for an unknown key or
/// value, the nearest valid one. Meshes that the scene names are read and placed.
Scene read_scene(const std::filesystem::path& file);
/// The same from text; `name` stands for the file in messages, `directory` is where relative names start.
Scene parse_scene(const std::string& text, const std::string& name, const std::filesystem::path& directory);
/// The scene with every key written out, readable by read_scene; file names are written absolute, so that the file can
/// stand anywhere.
std::string write_scene(const Scene& scene);
/// Sets a key of the section "tracking" (its name alone) to a value as it would stand in a scene file; quotes may be
/// left out. @throws InputError with what was expected, where there is no such key or it takes no such value.
void set_tracking_key(TrackingSpec& tracking, const std::string& key, const std::string& value);
/// Whether a JSON text has a key that scenes have at the top, or one much like it; true also where it is no JSON.
bool is_like_scene(const std::string& text);
/// All keys in the order of the file.
std::vector<SceneKey> scene_keys();

}  // namespace flowskin::scenes
