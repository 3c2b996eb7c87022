#include "tools/pipeline/run_start.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "common/errors.h"
#include "scenes/scene_checks.h"
#include "scenes/scene_file.h"
#include "scenes/sources/make_source.h"
#include "tools/pipeline/input_files.h"
#include "tools/pipeline/tracker_bridge.h"
#include "tools/report/run_log.h"
#include "tools/report/stage_clock.h"
#include "tools/textures/texture_mapping.h"

namespace flowskin::tools {

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
    const RestFrame rest = rest_frame(state.rest_positions);
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

void check_inputs_stay(const scenes::Scene& scene, const RunDirectory& directory) {
  if (scene.particles.source != scenes::ParticlesSpec::Source::recorded) return;
  namespace fs = std::filesystem;
  for (const std::string& name : scene.particles.recorded.files) {
    const fs::path file = scenes::absolute_name(scene.directory, name);
    std::error_code error;
    const fs::path folder = fs::weakly_canonical(fs::is_directory(file, error) ? file : file.parent_path(), error);
    for (const fs::path& cleared :
         {directory.particle_folder(), directory.surface_folder(), directory.image_folder()}) {
      if (fs::weakly_canonical(cleared, error) == folder)
        throw InputError(
            fmt::format("{} holds the particles to be tracked, and a run into {} would remove them; give "
                        "another folder to --out",
                        folder.string(), directory.root().string()));
    }
  }
}

}  // namespace flowskin::tools
