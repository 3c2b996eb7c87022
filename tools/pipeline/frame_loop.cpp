#include "tools/pipeline/frame_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "common/bounds.h"
#include "common/errors.h"
#include "common/outliers.h"
#include "scenes/io/atomic_file.h"
#include "scenes/scene_file.h"
#include "tools/pipeline/interruption.h"
#include "tools/pipeline/nearer_state.h"
#include "tools/pipeline/run_report.h"
#include "tools/pipeline/surface_doubts.h"
#include "tools/textures/texture_mapping.h"

namespace flowskin::tools {

namespace {

std::string command_to_resume(const RunOptions& options) {
  if (options.resume) return options.command_line;
  const std::string overwrite = " --overwrite";
  std::string command = options.command_line + " ";
  if (const auto place = command.find(overwrite + " "); place != std::string::npos)
    command.erase(place, overwrite.size());
  return command + "--resume";
}

/// Of the fluid at the start, without particles that flew off: what pictures show.
Box box_of_most(const scenes::ParticleSource& source) {
  return bounds(without_outliers(source.state().positions, kPictureMargin * source.spacing()));
}

}  // namespace

FrameLoop::FrameLoop(const RunOptions& options, RunStart start, const RunDirectory& directory, RunRecorder& recorder,
                     Checkpoint* resumed)
    : options_(options),
      directory_(directory),
      recorder_(recorder),
      log_(directory.log(), options.quiet, resumed != nullptr),
      checkpoints_(directory, checkpoint_header(start, options.compare), start.scene.output.checkpoint_interval),
      scene_(std::move(start.scene)),
      source_(std::move(start.source)),
      output_(directory, scene_, start.texture, box_of_most(*source_), clock_.stages),
      table_(directory.frames_csv(), WallSolids(scene_), scene_.output.checks, clock_.stages) {
  clock_.add_earlier("source", start.seconds);
  if (resumed) log_.detail("resumed");
  log_.detail(version_text());
  log_.detail("command: " + options_.command_line);
  log_.detail("machine: " + machine_text());
  if (scene_.tracking.enabled) clock_.stages.time("tracking", [&] { track_first_state(); });
  if (const auto methods = methods_to_compare(options_.compare); !methods.empty()) {
    comparison_ = std::make_unique<Comparison>(scene_, directory_, methods, surface_->tracker(),
                                               to_particles(source_->state()), clock_.stages);
    if (scene_.render.enabled) comparison_->make_pictures(start.texture, box_of_most(*source_));
  }
  if (resumed)
    checkpoints_.resume(*resumed, [&](StateReader& reader) {
      source_->restore(reader);
      visit(reader);
      check_restored(resumed->header().frame);
    });
  scenes::write_file(directory_.scene(), scenes::write_scene(scene_));
}

/// @throws StateError where the place in the run that was restored is none.
void FrameLoop::check_restored(int last_frame) const {
  const int steps = surface_ ? scene_.tracking.steps_per_frame : 1;
  const double time = source_->state().time, hair = 1e-6 / scene_.frame_rate;
  const double before = std::max(0, frame_ - 1) / scene_.frame_rate, after = frame_ / scene_.frame_rate;
  if (frame_ != last_frame + 1 || frame_ < 0 || table_.rows().size() != static_cast<std::size_t>(frame_) ||
      steps_done_ < 0 || steps_done_ > steps || !(time >= before - hair && time <= after + hair))
    throw StateError("the saved place in the run contradicts itself");
}

/// A field that cannot be surfaced at the start is the input's.
void FrameLoop::track_first_state() {
  try {
    surface_.emplace(scene_, source_->state());
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("the particles at the start have no surface that can be tracked: {}", error.what()));
  }
}

void FrameLoop::run() {
  for (const std::string& line : lines_at_start(scene_, *source_, surface())) log_.info(line);
  for (const std::string& warning : source_->warnings()) log_.warning("warning: " + warning);
  if (comparison_) log_.info(comparison_->description());
  if (checkpoints_.saved() >= 0) log_.info(fmt::format("resumed after frame {}", checkpoints_.saved()));
  Progress progress("frame", scene_.frames, options_.quiet ? Progress::Mode::quiet : Progress::Mode::automatic, frame_);
  try {
    go_through_frames(progress);
    progress.finish();
    finish();
  } catch (const std::exception& error) {
    progress.finish();
    fail(error);
  }
  require_surface();
}

/// A whole run without any surface has failed, though there is nothing to go on with.
void FrameLoop::require_surface() {
  const std::vector<FrameRow>& rows = table_.rows();
  if (!surface_ || std::any_of(rows.begin(), rows.end(), [](const FrameRow& row) { return row.vertices > 0; })) return;
  const std::string message =
      "no frame has a surface: " + why_no_surface(rows, nearer_state(source_->state()).positions, source_->spacing());
  log_.detail(message);
  throw RunError(message);
}

void FrameLoop::go_through_frames(Progress& progress) {
  while (frame_ <= scene_.frames) {
    if (frame_ > 0) advance();
    record();
    progress.update(frame_, fmt::format("t {:.3f} s  {} particles  {} vertices", source_->state().time,
                                        source_->state().positions.size(),
                                        surface_ ? surface_->tracker().mesh().positions.size() : 0));
    ++frame_;
    steps_done_ = 0;
    save_regularly();
    if (frame_ <= scene_.frames) pause();
  }
}

/// Goes on to the frame, from where the run is: a checkpoint may lie between two steps.
void FrameLoop::advance() {
  const int steps = surface_ ? scene_.tracking.steps_per_frame : 1;
  while (steps_done_ < steps) step_to((frame_ - 1 + double(steps_done_ + 1) / steps) / scene_.frame_rate);
}

/// Particles, surface, and what is compared with it.
void FrameLoop::step_to(double time) {
  const auto is_due = [&] { return is_to_pause(); };
  while (!clock_.stages.time("source", [&] { return source_->advance_towards(time, is_due); })) pause();
  ++steps_done_;
  if (!surface_) return;
  const tracking::Particles particles = surface_->with_textures(source_->state());
  const double tracked_before = clock_.stages.seconds("tracking");
  clock_.stages.time("tracking", [&] { surface_->advance(particles); });
  table_.add_step(surface_->tracker().report());
  if (const std::string warning = surface_->warning(); !warning.empty()) log_.warning(warning);
  if (comparison_) comparison_->advance(particles, clock_.stages.seconds("tracking") - tracked_before);
  pause();
}

/// Files, pictures and numbers of the frame: all of them are on the disk then, or none is there.
void FrameLoop::record() {
  scenes::FileBatch files;
  const RestFrame rest = rest_frame_of(scene_.texture);
  const ParticleFrame particles = dress(nearer_state(source_->state()), source_->spacing(), rest);
  std::optional<SurfaceFrame> shown;
  if (surface_)
    shown = surface_->frame(source_->state(), frame_ == 0 ? 0 : 1 / scene_.frame_rate, frame_ / scene_.frame_rate);
  const SurfaceFrame* shown_surface = shown ? &*shown : nullptr;
  doubt_first_surface();
  output_.write(frame_, particles, shown_surface);
  if (comparison_) comparison_->record(frame_, rest, particles);
  const FrameRow& row = table_.add_frame(frame_, *source_, particles.state.positions.size(), surface(), shown_surface);
  try {
    clock_.stages.time("forcing to the disk", [&] { files.commit(); });
  } catch (...) {
    table_.drop_frame();
    throw;
  }
  recorder_.keep_frame();
  if (row.reextractions > 0)
    log_.detail(fmt::format("frame {}: surface extracted anew {} time(s): {}", frame_, row.reextractions,
                            table_.statistics().last_reason()));
}

/// Once a run, for recorded particles, whose spacing may be a guess.
void FrameLoop::doubt_first_surface() {
  if (!surface_ || scene_.particles.source != scenes::ParticlesSpec::Source::recorded) return;
  if (std::any_of(table_.rows().begin(), table_.rows().end(), [](const FrameRow& row) { return row.vertices > 0; }))
    return;
  const std::size_t particles = nearer_state(source_->state()).positions.size();
  for (const std::string& doubt : surface_doubts(surface_->tracker().mesh(), particles, source_->spacing()))
    log_.warning("warning: " + doubt);
}

/// Whether a signal has come.
bool FrameLoop::is_to_pause() const { return interrupted() || hung_up(); }

/// At a safe point: the run stops where it has been asked to, and saves where the terminal is gone.
void FrameLoop::pause() {
  if (interrupted()) stop();
  if (!hung_up()) return;
  note_hangup();
  log_.info(
      fmt::format("SIGHUP (the terminal is closed): the run goes on; frame {} of {} is next", frame_, scene_.frames));
  if (checkpoints_.are_wanted()) try_to_save();
}

/// After a whole frame, or between two.
void FrameLoop::save() {
  clock_.stages.time("checkpoints", [&] {
    checkpoints_.save(frame_ - 1, [&](StateWriter& writer) {
      source_->save(writer);
      visit(writer);
    });
  });
}

/// A run does not end because it cannot be resumed: where the disk is full, the next frame will tell.
void FrameLoop::save_regularly() {
  if (checkpoints_.is_due(frame_ - 1, scene_.frames)) try_to_save();
}

void FrameLoop::try_to_save() {
  try {
    save();
  } catch (const RunError& error) {
    log_.warning(fmt::format("no checkpoint after frame {}: {}", frame_ - 1, error.what()));
  }
}

/// At a safe point, because of a signal.
void FrameLoop::stop() {
  const std::string where = steps_done_ > 0 || frame_ == 0 ? fmt::format("on the way to frame {}", frame_)
                                                           : fmt::format("after frame {}", frame_ - 1);
  const std::string what = fmt::format("interrupted by {} {} of {}", interruption_name(), where, scene_.frames);
  if (!checkpoints_.are_wanted()) throw InterruptedError(what);
  try {
    save();
  } catch (const RunError& error) {
    throw InterruptedError(fmt::format("{}; no checkpoint: {}", what, error.what()));
  }
  throw InterruptedError(what);
}

/// Says what happened, what is kept and how to go on.
void FrameLoop::fail(const std::exception& error) {
  const bool stopped = dynamic_cast<const InterruptedError*>(&error) != nullptr;
  std::string message = plain_message(error);
  if (!stopped && frame_ <= scene_.frames) message = fmt::format("in frame {}: {}", frame_, message);
  if (dynamic_cast<const sph::BlowUpError*>(&error) != nullptr && checkpoints_.saved() >= 0)
    message +=
        " (max_speed, speed_of_sound, max_time_step and the cfl numbers may be changed in the scene, under "
        "\"simulation\", before it is resumed)";
  message += "\n" + what_is_kept();
  log_.detail(message);
  if (stopped || interrupted()) throw InterruptedError(message);
  if (table_.rows().empty() && dynamic_cast<const InputError*>(&error) != nullptr) throw InputError(message);
  throw RunError(message);
}

std::string FrameLoop::what_is_kept() const {
  if (table_.rows().empty()) return "no frame was finished";
  const std::string root = directory_.root().string();
  if (std::string loss = recorder_.loss(); !loss.empty()) return loss;
  const std::string kept =
      fmt::format("frames 0 to {} are whole in {}; `flowskin render {}` makes their pictures and videos",
                  table_.rows().back().frame, root, root);
  if (checkpoints_.saved() < 0) return kept;
  return kept + fmt::format("\nto go on after frame {}: {}", checkpoints_.saved(), command_to_resume(options_));
}

/// Videos, plots, and what the log says of the whole run.
void FrameLoop::finish() {
  const auto to_log = [&](const std::string& line) { log_.info(line); };
  output_.finish(to_log);
  if (comparison_) clock_.stages.time("comparison", [&] { comparison_->finish(to_log); });
  log_.detail("at the end: " + source_->statistics().summary);
  for (const std::string& line : lines_at_end(scene_, *source_, surface(), table_, clock_)) log_.info(line);
  if (comparison_)
    for (const std::string& line : comparison_->ranking()) log_.info(line);
  scenes::sync_file_system(directory_.root());
  checkpoints_.mark_complete(scene_.frames);
  const std::string empty = surface_ ? empty_frames(table_.rows()) : "";
  if (!empty.empty()) log_.warning("warning: " + empty);
  log_.info("done: " + directory_.root().string());
  if (!log_.failure().empty()) log_.warning("log.txt is not complete: " + log_.failure());
  recorder_.finish(scene_.frames);
}

}  // namespace flowskin::tools
