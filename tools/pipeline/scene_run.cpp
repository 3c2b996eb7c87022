#include "tools/pipeline/scene_run.h"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "scenes/scene_checks.h"
#include "scenes/scene_file.h"
#include "scenes/sources/make_source.h"
#include "tools/errors.h"
#include "tools/io/atomic_file.h"
#include "tools/pipeline/comparison.h"
#include "tools/pipeline/frame_statistics.h"
#include "tools/pipeline/frame_writer.h"
#include "tools/pipeline/interruption.h"
#include "tools/pipeline/picture_maker.h"
#include "tools/pipeline/run_directory.h"
#include "tools/pipeline/tracker_bridge.h"
#include "tools/report/frames_csv.h"
#include "tools/report/progress.h"
#include "tools/report/run_log.h"
#include "tools/report/stage_clock.h"
#include "tools/report/worst_frames.h"
#include "tools/textures/texture_generations.h"
#include "tools/textures/texture_mapping.h"

namespace flowskin::tools {

namespace {

/// Of blended states, in effective radii: beyond it they show the fluid twice.
constexpr double kLargestMismatch = 0.5;

scenes::Scene scene_as_run(scenes::Scene scene, const RunOptions& options) {
  if (options.frames) scene.frames = *options.frames;
  if (options.velocity) scene.tracking.velocity = *options.velocity;
  scene.render.enabled = scene.render.enabled && options.pictures;
  scene.output.video = scene.output.video && options.video;
  return scene;
}

/// @throws InputError where the run would remove the particles that it is to read.
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

/// The particles as they are written and drawn: of two blended states those of the nearer one.
scenes::ParticleState of_nearer_state(const scenes::ParticleState& state) {
  if (state.weights.empty()) return state;
  const std::size_t count = state.ids.size(), earlier = state.earlier_count;
  const bool is_earlier = earlier > 0 && state.weights.front() >= 0.5;
  const auto begin = static_cast<std::ptrdiff_t>(is_earlier ? 0 : earlier);
  const auto end = static_cast<std::ptrdiff_t>(is_earlier ? earlier : count);
  const auto part = [&](const auto& values) { return std::vector(values.begin() + begin, values.begin() + end); };
  scenes::ParticleState nearer = state;
  nearer.ids = part(state.ids);
  nearer.positions = part(state.positions);
  nearer.velocities = part(state.velocities);
  nearer.rest_positions = part(state.rest_positions);
  nearer.densities = part(state.densities);
  nearer.weights.clear();
  nearer.earlier_count = 0;
  return nearer;
}

/// The state of one run; `frame` does the work of one frame, in the order of the data.
class SceneRun {
 public:
  SceneRun(const RunOptions& options, scenes::Scene scene, const RunDirectory& directory);

  void run();

 private:
  void start_comparison();
  void describe();
  void advance(int frame);
  void record(int frame);
  void warn_of_ghosts(double time);
  void write_row(int frame, std::size_t particles, const SurfaceFrame* surface);
  void finish(double started);

  const RunOptions& options_;
  scenes::Scene scene_;
  const RunDirectory& directory_;
  RunLog log_;
  StageClock clock_;
  std::unique_ptr<scenes::ParticleSource> source_;
  RestFrame rest_;
  Image texture_;
  std::unique_ptr<tracking::Tracker> tracker_;
  std::unique_ptr<TextureGenerations> generations_;
  std::unique_ptr<FrameWriter> writer_;
  std::unique_ptr<PictureMaker> pictures_;
  std::unique_ptr<Comparison> comparison_;
  FrameStatistics statistics_;
  std::vector<FrameRow> rows_;
  bool warned_of_ghosts_ = false;
  std::map<std::string, double> booked_;  // seconds of each stage up to the last row
};

SceneRun::SceneRun(const RunOptions& options, scenes::Scene scene, const RunDirectory& directory)
    : options_(options), scene_(std::move(scene)), directory_(directory), log_(directory.log(), options.quiet) {
  log_.detail(version_text());
  log_.detail("command: " + options_.command_line);
  log_.detail("machine: " + machine_text());
  source_ = clock_.time("source", [&] { return scenes::make_source(scene_); });
  const scenes::ParticleState& start = source_->state();
  scene_.tracking.velocity = velocity_method_for(scene_.tracking.velocity, start);
  if (scene_.tracking.enabled && !start.has_velocities && tracking::needs_particle_velocities(scene_.tracking.velocity))
    throw InputError(
        fmt::format("the velocity method \"{}\" needs the particles' velocities, but the recorded particles "
                    "have neither velocities nor ids to find them by; choose one that goes by the field alone, "
                    "such as affine, or record velocities",
                    scene_.tracking.velocity));
  if (scene_.texture.rest_size <= 0) {
    const RestFrame rest = rest_frame(start.rest_positions);
    scene_.texture.rest_center = rest.center;
    scene_.texture.rest_size = rest.size;
  }
  rest_ = {scene_.texture.rest_center, scene_.texture.rest_size};
  write_file(directory_.scene(), scenes::write_scene(scene_));
  texture_ = make_texture(scene_.texture.image, scene_.directory);
  if (scene_.tracking.enabled) {
    tracker_ = clock_.time(
        "tracking", [&] { return std::make_unique<tracking::Tracker>(tracker_settings(scene_), to_particles(start)); });
  }
  generations_ = std::make_unique<TextureGenerations>(scene_.texture, rest_);
  writer_ = std::make_unique<FrameWriter>(directory_, scene_.output, texture_);
  if (scene_.render.enabled)
    pictures_ = std::make_unique<PictureMaker>(directory_, scene_, texture_, bounds(start.positions));
  if (!options_.compare.empty()) start_comparison();
}

void SceneRun::start_comparison() {
  const scenes::ParticleState& start = source_->state();
  comparison_ = std::make_unique<Comparison>(scene_, directory_, methods_to_compare(options_.compare), *tracker_,
                                             to_particles(start), clock_);
  if (scene_.render.enabled) comparison_->make_pictures(texture_, bounds(start.positions));
}

void SceneRun::describe() {
  log_.info(fmt::format("scene {}: {} frames at {} per second, {} particles, {} thread(s)", scene_.name, scene_.frames,
                        scene_.frame_rate, source_->state().positions.size(), omp_get_max_threads()));
  if (const auto summary = source_->statistics().summary; !summary.empty()) log_.info("particles: " + summary);
  if (tracker_) {
    const tracking::TrackerSettings& settings = tracker_->settings();
    log_.info(fmt::format(
        "surface: {} vertices, velocity {}, {}, effective radius {:.4g} m, threshold {:.4g}, edge {:.4g} m, {} "
        "fairing iterations",
        tracker_->mesh().positions.size(), settings.velocity, scene_.tracking.integrator, settings.field.radius,
        settings.field.threshold, settings.edge_length, settings.fairing_iterations));
  }
  if (comparison_) log_.info(comparison_->description());
}

void SceneRun::advance(int frame) {
  const int steps = tracker_ ? scene_.tracking.steps_per_frame : 1;
  for (int step = 1; step <= steps; ++step) {
    const double time = (frame - 1 + double(step) / steps) / scene_.frame_rate;
    clock_.time("source", [&] { source_->advance_to(time); });
    if (!tracker_) continue;
    tracking::Particles particles = to_particles(source_->state());
    generations_->carry(particles);
    const double tracked_before = clock_.seconds("tracking");
    clock_.time("tracking", [&] { tracker_->advance(particles); });
    statistics_.add(tracker_->report());
    warn_of_ghosts(time);
    if (comparison_) comparison_->advance(particles, clock_.seconds("tracking") - tracked_before);
  }
}

void SceneRun::warn_of_ghosts(double time) {
  const tracking::TrackerReport& report = tracker_->report();
  const double radius = tracker_->settings().field.radius;
  if (warned_of_ghosts_ || !report.blended || report.mismatch <= kLargestMismatch * radius) return;
  warned_of_ghosts_ = true;
  const double times = std::ceil(report.mismatch / (kLargestMismatch * radius));
  log_.warning(
      fmt::format("at {:.4g} s particles are up to {:.3g} m from any of the state before, more than half the effective "
                  "radius ({:.3g} "
                  "m), and nobody knows which is which: the surface between the two states shows the fluid twice. "
                  "Record at least {} "
                  "times as many frames, write ids or velocities with the particles, or take a larger --radius",
                  time, report.mismatch, radius, times));
}

void SceneRun::record(int frame) {
  const scenes::ParticleState state = of_nearer_state(source_->state());
  const double time = frame / scene_.frame_rate;
  const ParticleFrame particles = dress(state, source_->spacing(), rest_);
  std::unique_ptr<SurfaceFrame> surface;
  if (tracker_) {
    generations_->update(*tracker_, to_particles(source_->state()), frame == 0 ? 0 : 1 / scene_.frame_rate);
    surface = std::make_unique<SurfaceFrame>(generations_->dress(tracker_->mesh(), time));
    surface->texture_file = FrameWriter::kTextureFile;
    if (scene_.tracking.confidence || scene_.render.style == "confidence")
      surface->confidence = confidence_attribute(*tracker_);
  }
  clock_.time("writing", [&] {
    writer_->write(frame, particles);
    if (surface) writer_->write(frame, *surface);
  });
  if (pictures_) {
    clock_.time("pictures", [&] {
      pictures_->draw(frame, particles);
      if (surface) pictures_->draw(frame, *surface);
    });
  }
  if (comparison_) comparison_->record(frame, rest_, particles);
  write_row(frame, state.positions.size(), surface.get());
}

void SceneRun::write_row(int frame, std::size_t particles, const SurfaceFrame* surface) {
  FrameRow row =
      clock_.time("statistics", [&] { return statistics_.finish_frame(frame, *source_, tracker_.get(), surface); });
  row.overstretched = generations_->overstretched();
  row.particles = particles;  // of blended states those that are written
  const auto since_last_row = [&](const char* stage) {
    const double total = clock_.seconds(stage);
    return total - std::exchange(booked_[stage], total);
  };
  row.seconds_source = since_last_row("source");
  row.seconds_tracking = since_last_row("tracking");
  row.seconds_writing = since_last_row("writing");
  row.seconds_pictures = since_last_row("pictures");
  row.seconds_statistics = since_last_row("statistics");
  rows_.push_back(row);
  write_frames_csv(directory_.frames_csv(), rows_);
  if (row.reextractions > 0)
    log_.detail(fmt::format("frame {}: surface extracted anew {} time(s): {}", frame, row.reextractions,
                            statistics_.last_reason()));
}

void SceneRun::run() {
  const double started = wall_seconds();
  describe();
  Progress progress("frame", scene_.frames, options_.quiet ? Progress::Mode::quiet : Progress::Mode::automatic);
  try {
    for (int frame = 0; frame <= scene_.frames; ++frame) {
      if (frame > 0) advance(frame);
      record(frame);
      const std::size_t vertices = tracker_ ? tracker_->mesh().positions.size() : 0;
      progress.update(frame, fmt::format("t {:.3f} s  {} particles  {} vertices", source_->state().time,
                                         source_->state().positions.size(), vertices));
      if (interrupted() && frame < scene_.frames)
        throw RunError(fmt::format("interrupted after frame {} of {}", frame, scene_.frames));
    }
  } catch (const std::exception& error) {
    progress.finish();
    const std::string kept = rows_.empty()
                                 ? "no frame was finished"
                                 : fmt::format(
                                       "frames 0 to {} are whole in {}; `flowskin render {}` makes "
                                       "their pictures and videos",
                                       rows_.back().frame, directory_.root().string(), directory_.root().string());
    throw RunError(fmt::format("{}\n{}", error.what(), kept));
  }
  progress.finish();
  finish(started);
}

void SceneRun::finish(double started) {
  const auto to_log = [&](const std::string& line) { log_.info(line); };
  if (pictures_) {
    clock_.time("contact sheet", [&] { make_contact_sheet(directory_, scene_.frame_rate); });
    if (scene_.output.video) clock_.time("videos", [&] { make_videos(directory_, scene_.frame_rate, to_log); });
  }
  if (comparison_) clock_.time("comparison", [&] { comparison_->finish(to_log); });
  log_.detail("at the end: " + source_->statistics().summary);
  for (const auto& [stage, seconds] : clock_.stages()) log_.info(fmt::format("{:>14}: {:8.2f} s", stage, seconds));
  log_.info(fmt::format("{:>14}: {:8.2f} s", "in all", wall_seconds() - started));
  log_.info(fmt::format("{:>14}: {:8.0f} MB at most", "memory", peak_memory()));
  if (tracker_)
    log_.info(fmt::format("the guard extracted the surface anew in {} of {} frames", statistics_.frames_reextracted(),
                          scene_.frames));
  if (tracker_)
    if (const std::string line = worst_frames(rows_, tracker_->settings().edge_length); !line.empty()) log_.info(line);
  const auto& last = rows_.back();
  log_.info(fmt::format("particles that left the domain: {}; poured: {}; drained: {}; paths stopped at a wall: {}",
                        last.left_domain, last.emitted, last.drained, last.wall_crossings));
  if (comparison_)
    for (const std::string& line : comparison_->ranking()) log_.info(line);
  log_.info("done: " + directory_.root().string());
}

}  // namespace

void run_scene(const RunOptions& options) {
  RunOptions with_folder = options;
  if (options.out.empty()) with_folder.out = std::filesystem::path("output") / options.scene_file.stem();
  run_scene(scenes::read_scene(options.scene_file, scene_vocabulary()), with_folder);
}

void run_scene(scenes::Scene scene, const RunOptions& options) {
  if (options.threads > 0) omp_set_num_threads(options.threads);
  if (!methods_to_compare(options.compare).empty() && !scene.tracking.enabled)
    throw InputError(fmt::format("--compare needs a tracked surface, but {} has tracking.enabled false",
                                 options.scene_file.string()));
  const RunDirectory directory(options.out);
  check_inputs_stay(scene, directory);
  directory.prepare();
  catch_interruptions();
  SceneRun(options, scene_as_run(std::move(scene), options), directory).run();
}

}  // namespace flowskin::tools
