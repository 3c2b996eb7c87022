// flowskin scene: what a scene file may say.
#include <fmt/format.h>

#include "scenes/scene_file.h"
#include "tools/commands/commands.h"

namespace flowskin::tools {

namespace {

/// A `|` inside a table cell would end it.
std::string cell(const std::string& text) {
  std::string escaped;
  for (char c : text) {
    if (c == '|') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

}  // namespace

int scene_command(const std::string& what) {
  if (what == "defaults") {
    fmt::print("{}\n", scenes::write_scene(scenes::Scene{}));
    return 0;
  }
  fmt::print("| key | type | unit | default | meaning |\n|---|---|---|---|---|\n");
  for (const auto& key : scenes::scene_keys())
    fmt::print("| `{}` | {} | {} | {} | {} |\n", key.path, cell(key.type), cell(key.unit), cell(key.default_value),
               cell(key.meaning));
  return 0;
}

}  // namespace flowskin::tools
