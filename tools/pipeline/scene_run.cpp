#include "tools/pipeline/scene_run.h"

#include <fmt/format.h>
#include <omp.h>

#include <map>
#include <memory>
#include <string>
#include <utility>

#include "scenes/scene_file.h"
#include "scenes/sources/make_source.h"
#include "tools/errors.h"
#include "tools/io/atomic_file.h"
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
#include "tools/textures/texture_mapping.h"

namespace flowskin::tools {

namespace {

scenes::Scene scene_as_run(const RunOptions& options) {
  scenes::Scene scene = scenes::read_scene(options.scene_file, scene_vocabulary());
  if (options.frames) scene.frames = *options.frames;
  if (options.velocity) scene.tracking.velocity = *options.velocity;
  scene.render.enabled = scene.render.enabled && options.pictures;
  scene.output.video = scene.output.video && options.video;
  return scene;
}

/// The state of one run; `frame` does the work of one frame, in the order of the data.
class SceneRun {
 public:
  SceneRun(const RunOptions& options, scenes::Scene scene, const RunDirectory& directory);

  void run();

 private:
  void describe();
  void advance(int frame);
  void record(int frame);
  void write_row(int frame, const SurfaceFrame* surface);
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
  std::unique_ptr<FrameWriter> writer_;
  std::unique_ptr<PictureMaker> pictures_;
  FrameStatistics statistics_;
  std::vector<FrameRow> rows_;
  std::map<std::string, double> booked_;  // seconds of each stage up to the last row
};

SceneRun::SceneRun(const RunOptions& options, scenes::Scene scene, const RunDirectory& directory)
    : options_(options), scene_(std::move(scene)), directory_(directory), log_(directory.log(), options.quiet) {
  log_.detail(version_text());
  log_.detail("command: " + options_.command_line);
  log_.detail("machine: " + machine_text());
  source_ = clock_.time("source", [&] { return scenes::make_source(scene_); });
  const scenes::ParticleState& start = source_->state();
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
  writer_ = std::make_unique<FrameWriter>(directory_, scene_.output, texture_);
  if (scene_.render.enabled)
    pictures_ = std::make_unique<PictureMaker>(directory_, scene_, texture_, bounds(start.positions));
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
}

void SceneRun::advance(int frame) {
  const int steps = tracker_ ? scene_.tracking.steps_per_frame : 1;
  for (int step = 1; step <= steps; ++step) {
    const double time = (frame - 1 + double(step) / steps) / scene_.frame_rate;
    clock_.time("source", [&] { source_->advance_to(time); });
    if (!tracker_) continue;
    clock_.time("tracking", [&] { tracker_->advance(to_particles(source_->state())); });
    statistics_.add(tracker_->report());
  }
}

void SceneRun::record(int frame) {
  const scenes::ParticleState& state = source_->state();
  const double time = frame / scene_.frame_rate;
  const ParticleFrame particles = dress(state, source_->spacing(), rest_);
  std::unique_ptr<SurfaceFrame> surface;
  if (tracker_) {
    surface = std::make_unique<SurfaceFrame>(dress(tracker_->mesh(), time, scene_.texture, rest_));
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
  write_row(frame, surface.get());
}

void SceneRun::write_row(int frame, const SurfaceFrame* surface) {
  FrameRow row =
      clock_.time("statistics", [&] { return statistics_.finish_frame(frame, *source_, tracker_.get(), surface); });
  const auto since_last_row = [&](const char* stage) {
    const double total = clock_.seconds(stage);
    return total - std::exchange(booked_[stage], total);
  };
  row.seconds_source = since_last_row("source");
  row.seconds_tracking = since_last_row("tracking");
  row.seconds_writing = since_last_row("writing");
  row.seconds_pictures = since_last_row("pictures");
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
  if (pictures_) {
    clock_.time("contact sheet", [&] { make_contact_sheet(directory_, scene_.frame_rate); });
    if (scene_.output.video)
      clock_.time("videos", [&] {
        make_videos(directory_, scene_.frame_rate, [&](const std::string& line) { log_.info(line); });
      });
  }
  log_.detail("at the end: " + source_->statistics().summary);
  for (const auto& [stage, seconds] : clock_.stages()) log_.info(fmt::format("{:>14}: {:8.2f} s", stage, seconds));
  log_.info(fmt::format("{:>14}: {:8.2f} s", "in all", wall_seconds() - started));
  if (tracker_)
    log_.info(fmt::format("the guard extracted the surface anew in {} of {} frames", statistics_.frames_reextracted(),
                          scene_.frames));
  const auto& last = rows_.back();
  log_.info(fmt::format("particles that left the domain: {}; paths stopped at a wall: {}", last.left_domain,
                        last.wall_crossings));
  log_.info("done: " + directory_.root().string());
}

}  // namespace

void run_scene(const RunOptions& options) {
  if (options.threads > 0) omp_set_num_threads(options.threads);
  scenes::Scene scene = scene_as_run(options);
  const RunDirectory directory(options.out.empty() ? std::filesystem::path("output") / options.scene_file.stem()
                                                   : options.out);
  directory.prepare();
  catch_interruptions();
  SceneRun(options, std::move(scene), directory).run();
}

}  // namespace flowskin::tools
