#include "tools/pipeline/run_loop.h"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/errors.h"
#include "scenes/io/atomic_file.h"
#include "scenes/scene_file.h"
#include "tools/pipeline/interruption.h"
#include "tools/pipeline/resume.h"
#include "tools/report/time_table.h"
#include "tools/report/worst_frames.h"

namespace flowskin::tools {

namespace {

/// Of blended states, in effective radii: beyond it they show the fluid twice.
constexpr double kLargestMismatch = 0.5;

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

}  // namespace

SceneRun::SceneRun(const RunOptions& options, RunStart begin, const RunDirectory& directory, Checkpoint* resumed)
    : options_(options),
      scene_(std::move(begin.scene)),
      directory_(directory),
      checkpoints_(directory.checkpoint_folder()),
      log_(directory.log(), options.quiet, resumed != nullptr),
      source_(std::move(begin.source)),
      rest_{scene_.texture.rest_center, scene_.texture.rest_size} {
  began_ -= begin.seconds;
  if (resumed) log_.detail("resumed");
  log_.detail(version_text());
  log_.detail("command: " + options_.command_line);
  log_.detail("machine: " + machine_text());
  clock_.add("source", begin.seconds);
  const scenes::ParticleState& start = source_->state();
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
  if (resumed) restore(*resumed);
  scenes::write_file(directory_.scene(), scenes::write_scene(scene_));
}

CheckpointHeader SceneRun::header() const {
  return {version_text(), scenes::write_scene(scene_), checksums_of_files(scene_, texture_), options_.compare,
          frame_ - 1};
}

void SceneRun::save_checkpoint() {
  const double before = elapsed_;
  elapsed_ += wall_seconds() - began_;
  clock_.time("checkpoints", [&] {
    checkpoints_.save(header(), [&](StateWriter& writer) {
      source_->save(writer);
      visit(writer);
    });
  });
  elapsed_ = before;
  saved_ = frame_ - 1;
}

/// A run does not end because it cannot be resumed: where the disk is full, the next frame will tell.
void SceneRun::save_regularly() {
  const int interval = scene_.output.checkpoint_interval, done = frame_ - 1;
  if (interval == 0 || done == 0 || (done % interval != 0 && done != scene_.frames)) return;
  try {
    save_checkpoint();
  } catch (const RunError& error) {
    log_.warning(fmt::format("no checkpoint after frame {}: {}", done, error.what()));
  }
}

void SceneRun::restore(Checkpoint& checkpoint) {
  try {
    source_->restore(checkpoint.state());
    visit(checkpoint.state());
    if (checkpoint.state().bytes_left() > 0) throw StateError("there is more in it than is expected");
  } catch (const InputError& error) {
    checkpoint.refuse(std::string("cannot be resumed from: ") + error.what());
  } catch (const std::exception& error) {
    checkpoint.refuse(std::string("does not fit this program: ") + error.what() + "; run the scene anew");
  }
  saved_ = checkpoint.header().frame;
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
        "fairing iterations, texture slips {}",
        tracker_->mesh().positions.size(), settings.velocity, scene_.tracking.integrator, settings.field.radius,
        settings.field.threshold, settings.edge_length, settings.fairing_iterations,
        settings.max_slip > 0 ? fmt::format("{:.4g} m at most", settings.max_slip) : "freely"));
  }
  if (comparison_) log_.info(comparison_->description());
  if (saved_ >= 0) log_.info(fmt::format("resumed after frame {}", saved_));
}

void SceneRun::advance() {
  const int steps = tracker_ ? scene_.tracking.steps_per_frame : 1;
  while (steps_done_ < steps) {
    const double time = (frame_ - 1 + double(steps_done_ + 1) / steps) / scene_.frame_rate;
    if (!clock_.time("source", [&] { return source_->advance_towards(time, interrupted); })) stop();
    ++steps_done_;
    if (!tracker_) continue;
    tracking::Particles particles = to_particles(source_->state());
    generations_->carry(particles);
    const double tracked_before = clock_.seconds("tracking");
    clock_.time("tracking", [&] { tracker_->advance(particles); });
    statistics_.add(tracker_->report());
    warn_of_ghosts(time);
    if (comparison_) comparison_->advance(particles, clock_.seconds("tracking") - tracked_before);
    if (interrupted()) stop();
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

/// At a safe point, because of a signal.
void SceneRun::stop() {
  const std::string where = steps_done_ > 0 || frame_ == 0 ? fmt::format("on the way to frame {}", frame_)
                                                           : fmt::format("after frame {}", frame_ - 1);
  const std::string what = fmt::format("interrupted by {} {} of {}", interruption_name(), where, scene_.frames);
  if (scene_.output.checkpoint_interval == 0) throw InterruptedError(what);
  try {
    save_checkpoint();
  } catch (const RunError& error) {
    throw InterruptedError(fmt::format("{}; no checkpoint: {}", what, error.what()));
  }
  throw InterruptedError(what);
}

std::string SceneRun::what_is_kept() const {
  if (rows_.empty()) return "no frame was finished";
  std::string kept = fmt::format("frames 0 to {} are whole in {}; `flowskin render {}` makes their pictures and videos",
                                 rows_.back().frame, directory_.root().string(), directory_.root().string());
  if (saved_ < 0) return kept;
  const bool said = options_.resume;
  return kept + fmt::format("\nto go on after frame {}: {}{}", saved_, options_.command_line, said ? "" : " --resume");
}

void SceneRun::go_through_frames(Progress& progress) {
  while (frame_ <= scene_.frames) {
    if (frame_ > 0) advance();
    record(frame_);
    const std::size_t vertices = tracker_ ? tracker_->mesh().positions.size() : 0;
    progress.update(frame_, fmt::format("t {:.3f} s  {} particles  {} vertices", source_->state().time,
                                        source_->state().positions.size(), vertices));
    ++frame_;
    steps_done_ = 0;
    save_regularly();
    if (interrupted() && frame_ <= scene_.frames) stop();
  }
}

void SceneRun::run() {
  describe();
  Progress progress("frame", scene_.frames, options_.quiet ? Progress::Mode::quiet : Progress::Mode::automatic, frame_);
  try {
    go_through_frames(progress);
    progress.finish();
    finish();
  } catch (const InterruptedError& error) {
    progress.finish();
    const std::string message = fmt::format("{}\n{}", error.what(), what_is_kept());
    log_.detail(message);
    throw InterruptedError(message);
  } catch (const std::exception& error) {
    progress.finish();
    std::string message =
        frame_ <= scene_.frames ? fmt::format("in frame {}: {}", frame_, error.what()) : std::string(error.what());
    if (dynamic_cast<const sph::BlowUpError*>(&error) != nullptr && saved_ >= 0)
      message +=
          " (max_speed, speed_of_sound, max_time_step and the cfl numbers may be changed in the scene, under "
          "\"simulation\", before it is resumed)";
    message += "\n" + what_is_kept();
    log_.detail(message);
    if (interrupted()) throw InterruptedError(message);
    throw RunError(message);
  }
}

void SceneRun::report_times() {
  std::vector<StageTime> stages;
  for (const auto& [stage, seconds] : clock_.stages()) {
    StageTime& time = stages.emplace_back(StageTime{stage, seconds});
    if (stage == "source") time.parts = source_->statistics().seconds;
    if (stage == "tracking") time.parts = statistics_.tracking_seconds();
  }
  for (const std::string& line :
       time_table(stages, scene_.frames / scene_.frame_rate, elapsed_ + wall_seconds() - began_))
    log_.info(line);
}

void SceneRun::finish() {
  const auto to_log = [&](const std::string& line) { log_.info(line); };
  if (pictures_) {
    clock_.time("contact sheet", [&] { make_contact_sheet(directory_, scene_.frame_rate); });
    if (scene_.output.video) clock_.time("videos", [&] { make_videos(directory_, scene_.frame_rate, to_log); });
  }
  if (comparison_) clock_.time("comparison", [&] { comparison_->finish(to_log); });
  log_.detail("at the end: " + source_->statistics().summary);
  report_times();
  log_.info(fmt::format("memory: {:.0f} MB at most", peak_memory()));
  if (tracker_)
    log_.info(fmt::format("the guard extracted the surface anew in {} of {} frames", statistics_.frames_reextracted(),
                          scene_.frames));
  if (tracker_)
    if (const std::string line = worst_frames(rows_, tracker_->settings().edge_length); !line.empty()) log_.info(line);
  const auto& last = rows_.back();
  log_.info(fmt::format(
      "particles that left the domain: {}; poured: {}; drained: {}; paths stopped at a wall: {}, at a narrow gap: {}",
      last.left_domain, last.emitted, last.drained, last.wall_crossings, last.kept_out_of_gaps));
  if (comparison_)
    for (const std::string& line : comparison_->ranking()) log_.info(line);
  if (saved_ == scene_.frames) checkpoints_.mark_complete(scene_.frames);
  log_.info("done: " + directory_.root().string());
  if (!log_.failure().empty()) log_.warning("log.txt is not complete: " + log_.failure());
}

}  // namespace flowskin::tools
