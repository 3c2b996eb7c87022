// flowskin info FILE|FOLDER...: what is in it, and whether it is sound.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "common/errors.h"
#include "scenes/io/csv_reader.h"
#include "scenes/io/file_info.h"
#include "scenes/io/json_particles.h"
#include "scenes/io/read_bytes.h"
#include "scenes/scene_file.h"
#include "scenes/sources/particle_sequence.h"
#include "tools/commands/command.h"
#include "tools/pipeline/run_directory.h"
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

/// What a run has written: its scene, its rows of frames.csv, its last surface.
scenes::FileInfo describe_run(const RunDirectory& run) {
  scenes::FileInfo info = describe_scene(run.scene());
  info.lines.insert(info.lines.begin(), "a run directory of FlowSkin");
  const std::filesystem::path csv = run.frames_csv();
  const scenes::ParticleTable rows = scenes::parse_csv(scenes::read_bytes(csv), csv.string());
  const auto last = [&](const char* column) {
    const auto found = rows.columns.find(column);
    return found == rows.columns.end() || found->second.empty() ? std::nan("") : found->second.back();
  };
  info.lines.push_back(
      fmt::format("frames: {}, the last is number {} at {:.6g} s: {} particles, {} vertices, volume "
                  "{:.6g} m^3",
                  rows.count, last("frame"), last("time"), last("particles"), last("vertices"), last("volume")));
  const std::filesystem::path surface = run.surface_folder() / fmt::format("frame_{:04.0f}.ply", last("frame"));
  std::error_code error;
  if (!std::filesystem::exists(surface, error)) return info;
  const scenes::FileInfo mesh = scenes::describe_file(surface);
  info.lines.emplace_back("the last surface:");
  for (const std::string& line : mesh.lines) info.lines.push_back("  " + line);
  info.sound = mesh.sound;
  return info;
}

scenes::FileInfo describe(const std::filesystem::path& place) {
  std::error_code error;
  if (std::filesystem::is_directory(place, error)) {
    const RunDirectory run(place);
    const bool is_run = std::filesystem::exists(run.scene(), error) && std::filesystem::exists(run.frames_csv(), error);
    return is_run ? describe_run(run) : scenes::describe_sequence(place);
  }
  if (scenes::is_collection(place)) return scenes::describe_sequence(place);
  constexpr std::size_t telling = 64;
  const std::string start = scenes::first_bytes(place, telling);
  const std::size_t first = start.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  const bool is_json = place.extension() == ".json" || (first != std::string::npos && start[first] == '{');
  if (!is_json) return scenes::describe_file(place);
  const std::string text = scenes::read_bytes(place);
  if (scenes::is_json_particles(text)) return scenes::describe_file(place);
  if (!scenes::is_like_scene(text))
    throw InputError(
        fmt::format("{}: this JSON file is neither a scene nor particles: a scene has keys such as \"particles\" and "
                    "\"bodies\" (`flowskin scene --keys`), particles have \"positions\", or \"x\", \"y\" and \"z\"",
                    place.string()));
  return describe_scene(place);
}

/// Goes on after a file that cannot be read.
int describe_all(const std::vector<std::filesystem::path>& files) {
  std::vector<std::string> unread;
  bool sound = true;
  for (const auto& file : files) {
    try {
      const scenes::FileInfo info = describe(file);
      put(file.string() + "\n");
      for (const std::string& line : info.lines) put("  " + line + "\n");
      sound = sound && info.sound;
    } catch (const InputError& error) {
      if (files.size() == 1) throw;
      say_line(error.what());
      unread.push_back(file.filename().string());
    }
  }
  if (!unread.empty())
    throw InputError(
        fmt::format("{} of {} files cannot be read: {}", unread.size(), files.size(), fmt::join(unread, ", ")));
  if (!sound) throw InputError("not every file is sound; the lines above say what is wrong");
  return 0;
}

}  // namespace

Command info_command() {
  const auto files = std::make_shared<std::vector<std::filesystem::path>>();
  return {"info",
          "Say what is in a mesh, particle or scene file, a .pvd or a run directory, and whether it is sound",
          {{"files",
            files.get(),
            "Meshes (OBJ, PLY, VTP), particles of any format that track reads, scenes, folders",
            {.is_required = true}}},
          [files](const std::string&) { return describe_all(*files); }};
}

}  // namespace flowskin::tools
