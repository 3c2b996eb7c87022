// flowskin info FILE...: what is in a file, and whether it is sound.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "common/errors.h"
#include "scenes/io/file_info.h"
#include "scenes/scene_file.h"
#include "tools/commands/command.h"
#include "tools/pipeline/tracker_bridge.h"
#include "tools/report/messages.h"

namespace flowskin::tools {

namespace {

scenes::FileInfo describe_scene(const std::filesystem::path& file) {
  const scenes::Scene scene = scenes::read_scene(file);
  using Source = scenes::ParticlesSpec::Source;
  const Source source = scene.particles.source;
  const char* name = source == Source::simulation   ? "a simulation"
                     : source == Source::prescribed ? "prescribed motion"
                                                    : "a recorded sequence";
  const auto moving = std::count_if(scene.boundaries.begin(), scene.boundaries.end(),
                                    [](const scenes::BoundarySpec& wall) { return wall.boundary.motion.moves(); });
  scenes::FileInfo info;
  info.lines = {fmt::format("scene \"{}\"{}{}", scene.name, scene.description.empty() ? "" : ": ", scene.description),
                fmt::format("{} frames at {} per second, particles from {}, spacing {} m", scene.frames,
                            scene.frame_rate, name, scene.particles.spacing),
                fmt::format("{} fluid bodies, {} emitters, {} walls{}", scene.bodies.size(), scene.emitters.size(),
                            scene.boundaries.size(), moving > 0 ? fmt::format(", {} of them moving", moving) : ""),
                fmt::format("velocity method {}, texture {} ({} mapping)", scene.tracking.velocity, scene.texture.image,
                            scene.texture.mapping)};
  return info;
}

int describe_all(const std::vector<std::filesystem::path>& files) {
  bool sound = true;
  for (const auto& file : files) {
    const scenes::FileInfo info = file.extension() == ".json" ? describe_scene(file) : scenes::describe_file(file);
    put(file.string() + "\n");
    for (const std::string& line : info.lines) put("  " + line + "\n");
    sound = sound && info.sound;
  }
  if (!sound) throw InputError("not every file is sound; the lines above say what is wrong");
  return 0;
}

}  // namespace

Command info_command() {
  const auto files = std::make_shared<std::vector<std::filesystem::path>>();
  return {"info",
          "Say what is in a mesh, particle or scene file, and whether it is sound",
          {{"files", files.get(), "OBJ, PLY, particle (CSV, VTK, VTP) or scene files", {.is_required = true}}},
          [files](const std::string&) { return describe_all(*files); }};
}

}  // namespace flowskin::tools
