// flowskin render DIR: pictures and videos of a finished run, again.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "common/bounds.h"
#include "common/errors.h"
#include "common/thread_count.h"
#include "scenes/io/frame_files.h"
#include "scenes/io/ply_reader.h"
#include "scenes/scene_file.h"
#include "tools/commands/shared_options.h"
#include "tools/pipeline/interruption.h"
#include "tools/pipeline/picture_maker.h"
#include "tools/pipeline/run_folder.h"
#include "tools/pipeline/run_record.h"
#include "tools/pipeline/tracker_bridge.h"
#include "tools/report/messages.h"
#include "tools/report/progress.h"
#include "tools/textures/texture_mapping.h"

namespace flowskin::tools {

namespace {

/// Overrides of the run's scene; unset values are those of the scene.
struct RenderOptions {
  std::filesystem::path directory;
  int width = 0, height = 0, samples = 0;  ///< 0: as in the scene
  std::vector<double> camera, look_at;     ///< 3 numbers each (m), or empty
  double vertical_fov = 0;                 ///< degrees; 0: as in the scene
  std::string style;                       ///< empty: as in the scene
  std::string what = "both";               ///< surface, particles, both
  int threads = 0;
  bool no_video = false, quiet = false;
};

Vec3 vector_of(const std::vector<double>& numbers) { return {numbers[0], numbers[1], numbers[2]}; }

void override_settings(const RenderOptions& options, scenes::RenderSpec& render) {
  if (options.width > 0) render.width = options.width;
  if (options.height > 0) render.height = options.height;
  if (options.samples > 0) render.samples = options.samples;
  if (options.vertical_fov > 0) render.camera.vertical_fov = options.vertical_fov;
  if (!options.style.empty()) render.style = options.style;
  if (!options.camera.empty()) render.camera.position = vector_of(options.camera);
  if (!options.look_at.empty()) render.camera.look_at = vector_of(options.look_at);
  if ((render.camera.position - render.camera.look_at).norm() == 0 && !options.camera.empty())
    throw InputError("--camera and --look-at are the same point; the camera needs a direction");
}

/// Draws the frames that the run directory holds.
class Redraw {
 public:
  Redraw(const RenderOptions& options, const scenes::Scene& scene, const RunDirectory& directory)
      : options_(options), scene_(scene), directory_(directory), rest_(rest_frame_of(scene.texture)) {
    if (options.what != "particles")
      surface_frames_ = RunDirectory::frames_in(directory.surface_folder(), "frame_", ".ply");
    if (options.what != "surface")
      particle_frames_ = RunDirectory::frames_in(directory.particle_folder(), "frame_", ".ply");
    if (surface_frames_.empty() && particle_frames_.empty())
      throw InputError(
          fmt::format("{} has no frames to draw: surface/frame_*.ply or particles/frame_*.ply are needed "
                      "(keys output.ply and output.particles of the scene)",
                      directory.root().string()));
  }

  void draw() {
    std::filesystem::create_directories(directory_.image_folder());
    const Image texture = make_texture(scene_.texture.image, scene_.directory);
    const PictureMaker pictures(directory_, scene_, texture, fluid_at_start());
    const int total = int(surface_frames_.size() + particle_frames_.size());
    Progress progress("picture", total, options_.quiet ? Progress::Mode::quiet : Progress::Mode::automatic);
    int done = 0;
    for (int frame : surface_frames_) {
      const auto mesh = scenes::read_surface_ply(directory_.surface(frame, ".ply"));
      SurfaceFrame surface = dress(mesh, frame / scene_.frame_rate, scene_.texture, rest_);
      if (scene_.texture.when_stretched != "leave")
        scenes::read_surface_blend(directory_.surface(frame, ".ply"), surface);
      if (scene_.render.style == "confidence")
        surface.confidence = scenes::read_surface_confidence(directory_.surface(frame, ".ply"));
      pictures.draw(frame, surface);
      step(progress, ++done);
    }
    for (int frame : particle_frames_) {
      const auto state = scenes::particles_from_ply(directory_.particles(frame, ".ply"));
      pictures.draw(frame, dress(state, scene_.particles.spacing, rest_));
      step(progress, ++done);
    }
  }

 private:
  sph::Box fluid_at_start() const {
    if (!particle_frames_.empty())
      return bounds(scenes::particles_from_ply(directory_.particles(particle_frames_.front(), ".ply")).positions);
    return bounds(scenes::read_surface_ply(directory_.surface(surface_frames_.front(), ".ply")).positions);
  }

  static void step(Progress& progress, int done) {
    progress.update(done, "");
    if (interrupted()) throw InterruptedError("interrupted; the pictures made so far are whole");
  }

  const RenderOptions& options_;
  const scenes::Scene& scene_;
  const RunDirectory& directory_;
  RestFrame rest_;
  std::vector<int> surface_frames_, particle_frames_;
};

int render(const RenderOptions& options) {
  use_threads(options.threads);
  const RunDirectory directory(options.directory);
  directory.check_is_run();
  RunLock lock;
  lock.take(directory);
  scenes::Scene scene = scenes::read_scene(directory.scene());
  override_settings(options, scene.render);
  catch_interruptions();
  // Pictures are added to the record of what FlowSkin has written, where there is one.
  const RunFolder folder(directory);
  std::optional<RunRecorder> recorder;
  if (folder.has_record()) {
    folder.check_may_go_on();
    recorder.emplace(directory, RunRecorder::Work::pictures);
  }
  Redraw(options, scene, directory).draw();
  make_contact_sheet(directory, scene.frame_rate);
  if (!options.no_video)
    make_videos(directory, scene.frame_rate, [&](const std::string& line) {
      if (!options.quiet) say_line(line);
    });
  return 0;
}

}  // namespace

Command render_command() {
  const auto chosen = std::make_shared<RenderOptions>();
  const std::vector<Option> options{
      {"directory", &chosen->directory, "Run directory", {.is_required = true}},
      {"--width", &chosen->width, "Pixels (default: the scene's)", {.range = {{16, 16384}}}},
      {"--height", &chosen->height, "Pixels (default: the scene's)", {.range = {{16, 16384}}}},
      {"--samples", &chosen->samples, "Rays per pixel (default: the scene's)", {.range = {{1, 4096}}}},
      {"--camera", &chosen->camera, "Camera position x y z (m)", {.count = 3}},
      {"--look-at", &chosen->look_at, "Point the camera looks at, x y z (m)", {.count = 3}},
      {"--fov", &chosen->vertical_fov, "Vertical field of view (degrees)", {.range = {{1.0, 170.0}}}},
      {"--style",
       &chosen->style,
       "textured, solid, normals or confidence (default: the scene's)",
       {.words = {"textured", "solid", "normals", "confidence"}}},
      {"--what",
       &chosen->what,
       "surface, particles or both",
       {.words = {"surface", "particles", "both"}, .shows_default = true}},
      threads_option(chosen->threads, "Threads (default: all)"),
      {"--no-video", &chosen->no_video, "Pictures but no videos"},
      {"--quiet", &chosen->quiet, "No progress; warnings and errors only"},
  };
  return {"render", "Make the pictures and videos of a run again", options,
          [chosen](const std::string&) { return render(*chosen); }};
}

}  // namespace flowskin::tools
