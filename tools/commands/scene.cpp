// flowskin scene: what a scene file may say.
#include <fmt/format.h>

#include "scenes/scene_file.h"
#include "tools/commands/commands.h"

namespace flowskin::tools {

int scene_command(const std::string& what) {
  if (what == "defaults") {
    fmt::print("{}\n", scenes::write_scene(scenes::Scene{}));
    return 0;
  }
  fmt::print("| Key | Type | Unit | Default | Meaning |\n|---|---|---|---|---|\n");
  for (const auto& key : scenes::scene_keys())
    fmt::print("| `{}` | {} | {} | `{}` | {} |\n", key.path, key.type, key.unit, key.default_value, key.meaning);
  return 0;
}

}  // namespace flowskin::tools
