// flowskin scene: what a scene file may say.
#include <fmt/format.h>

#include <memory>

#include "scenes/scene_file.h"
#include "tools/commands/command.h"
#include "tools/report/messages.h"

namespace flowskin::tools {

namespace {

void print_keys() {
  put("| Key | Type | Unit | Default | Meaning |\n|---|---|---|---|---|\n");
  for (const auto& key : scenes::scene_keys())
    put(fmt::format("| `{}` | {} | {} | `{}` | {} |\n", key.path, key.type, key.unit, key.default_value, key.meaning));
}

}  // namespace

Command scene_command() {
  struct Chosen {
    bool defaults = false, keys = false;
  };
  const auto chosen = std::make_shared<Chosen>();
  const std::vector<Option> options{
      {"--defaults", &chosen->defaults, "A scene with every key at its default, as JSON"},
      {"--keys", &chosen->keys, "A table of all keys with unit, default and meaning (Markdown)"},
  };
  return {"scene", "Describe the scene file", options,
          [chosen](const std::string&) {
            if (chosen->defaults)
              put(scenes::write_scene(scenes::Scene{}) + "\n");
            else
              print_keys();
            return 0;
          },
          true};
}

}  // namespace flowskin::tools
