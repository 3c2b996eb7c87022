#include "tools/pipeline/run_start.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "common/errors.h"
#include "common/outliers.h"
#include "scenes/scene_checks.h"
#include "scenes/scene_file.h"
#include "scenes/sources/make_source.h"
#include "scenes/sources/particle_sequence.h"
#include "tools/pipeline/input_files.h"
#include "tools/pipeline/tracker_bridge.h"
#include "tools/report/run_log.h"
#include "tools/report/stage_clock.h"
#include "tools/textures/texture_mapping.h"

namespace flowskin::tools {

namespace fs = std::filesystem;

namespace {

scenes::Scene scene_as_run(scenes::Scene scene, const RunOptions& options) {
  if (options.frames) scene.frames = *options.frames;
  if (options.velocity) scene.tracking.velocity = *options.velocity;
  scene.render.enabled = scene.render.enabled && options.pictures;
  scene.output.video = scene.output.video && options.video;
  return scene;
}

}  // namespace

RunStart start_run(scenes::Scene scene, const RunOptions& options) {
  RunStart start{scene_as_run(std::move(scene), options), nullptr, {}, {}, 0};
  const double started = wall_seconds();
  start.source = scenes::make_source(start.scene);
  start.seconds = wall_seconds() - started;
  const scenes::ParticleState& state = start.source->state();
  scenes::TrackingSpec& tracking = start.scene.tracking;
  tracking.velocity = velocity_method_for(tracking.velocity, state);
  if (tracking.enabled && !state.has_velocities && tracking::needs_particle_velocities(tracking.velocity))
    throw InputError(
        fmt::format("the velocity method \"{}\" needs the particles' velocities, but the recorded particles "
                    "have neither velocities nor ids to find them by; choose one that goes by the field alone, "
                    "such as affine, or record velocities",
                    tracking.velocity));
  if (start.scene.texture.rest_size <= 0) {
    const RestFrame rest = rest_frame(without_outliers(state.rest_positions, kPictureMargin * start.source->spacing()));
    start.scene.texture.rest_center = rest.center;
    start.scene.texture.rest_size = rest.size;
  }
  start.texture = make_texture(start.scene.texture.image, start.scene.directory);
  start.files = input_files(start.scene, start.texture);
  return start;
}

CheckpointHeader checkpoint_header(const RunStart& start, const std::string& compare) {
  return {version_text(), scenes::write_scene(start.scene), start.files, compare};
}

std::vector<fs::path> files_needed(const scenes::Scene& scene, const fs::path& scene_file) {
  std::vector<fs::path> files;
  const auto add = [&](const std::string& name) {
    if (!name.empty()) files.emplace_back(scenes::absolute_name(scene.directory, name));
  };
  if (!scene_file.empty()) files.push_back(scene_file);
  for (const auto& spec : scene.bodies) add(spec.mesh.file);
  for (const auto& spec : scene.emitters) add(spec.mesh.file);
  for (const auto& spec : scene.sinks) add(spec.mesh.file);
  for (const auto& spec : scene.boundaries) add(spec.mesh.file);
  add(scene.texture.image);
  if (scene.particles.source == scenes::ParticlesSpec::Source::recorded)
    for (fs::path& file : scenes::sequence_files(scene.particles.recorded, scene.directory))
      files.push_back(std::move(file));
  return files;
}

std::string run_name(const scenes::Scene& scene, const fs::path& scene_file) {
  std::error_code error;
  if (!scene_file.empty()) return fs::weakly_canonical(fs::absolute(scene_file), error).string();
  std::string name = "tracked on";
  for (const std::string& file : scene.particles.recorded.files)
    name += " " + scenes::absolute_name(scene.directory, file);
  return name;
}

}  // namespace flowskin::tools
