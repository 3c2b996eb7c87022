// The scenes whose surfaces are tested at every frame.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace flowskin::surfaces {

inline const std::vector<std::string>& tested_scene_names() {
  static const std::vector<std::string> names = {"drops_merge",    "thread",  "pool_drop", "torus",
                                                 "sheet",          "enright", "zalesak",   "pouring_obstacle",
                                                 "stairs_preview", "stairs"};
  return names;
}

inline std::filesystem::path scene_file(const std::string& name) {
  return std::filesystem::path(FLOWSKIN_SOURCE_DIR) / "scenes" / (name + ".json");
}

inline std::vector<std::filesystem::path> tested_scenes() {
  std::vector<std::filesystem::path> files;
  for (const std::string& name : tested_scene_names()) files.push_back(scene_file(name));
  return files;
}

}  // namespace flowskin::surfaces
