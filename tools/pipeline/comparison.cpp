#include "tools/pipeline/comparison.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

#include "tools/pipeline/method_measures.h"
#include "tools/pipeline/tracker_bridge.h"
#include "tools/render/video.h"
#include "tools/report/compare_report.h"

namespace flowskin::tools {
namespace {

constexpr const char* kOthers = "other methods";  // stage of the clock
constexpr double kReachInSpacings = 2;            // of closest points

/// Whether the mesh of the scene's own run is the one that this method is to be judged by.
bool serves_for(const ComparedMethod& method, const tracking::TrackerSettings& settings) {
  return method.settings.empty() && method.velocity == settings.velocity && settings.max_slip == 0;
}

}  // namespace

Comparison::Comparison(const scenes::Scene& scene, const RunDirectory& directory,
                       const std::vector<ComparedMethod>& methods, const tracking::Tracker& scene_tracker,
                       const tracking::Particles& start, StageClock& clock)
    : scene_(scene),
      directory_(directory),
      scene_max_slip_(scene_tracker.settings().max_slip),
      truth_(scene, scene_tracker.settings(), start),
      clock_(clock) {
  for (const ComparedMethod& method : methods) {
    Entry& entry = entries_.emplace_back(Entry{method.name, nullptr, &scene_tracker, {}});
    if (serves_for(method, scene_tracker.settings())) continue;
    clock_.time(kOthers, [&] { entry.own = std::make_unique<tracking::Tracker>(settings_for(scene, method), start); });
    entry.tracker = entry.own.get();
  }
  truth_.start_markers(scene_tracker.mesh());
}

std::vector<std::string> Comparison::names() const {
  std::vector<std::string> names;
  for (const Entry& entry : entries_) names.push_back(entry.method);
  return names;
}

void Comparison::make_pictures(const Image& texture, const sph::Box& fluid) {
  pictures_ = std::make_unique<ComparisonPictures>(directory_, scene_, texture, fluid, names());
}

std::string Comparison::description() const {
  std::string text = fmt::format("comparing {} with {} markers that ride {}; {}", fmt::join(names(), ", "),
                                 truth_.markers().ids.size(), truth_.description(), kSlipFreely);
  if (scene_max_slip_ > 0)
    text += fmt::format(" (the surface that is written is held within max_slip = {:.4g} m and is not among them)",
                        scene_max_slip_);
  return text;
}

void Comparison::advance(const tracking::Particles& particles, double scene_tracker_seconds) {
  for (Entry& entry : entries_) {
    const double before = clock_.seconds(kOthers);
    if (entry.own) clock_.time(kOthers, [&] { entry.own->advance(particles); });
    entry.counts.seconds += entry.own ? clock_.seconds(kOthers) - before : scene_tracker_seconds;
    const tracking::TrackerReport& report = entry.tracker->report();
    entry.counts.reextractions += report.reextracted;
    entry.counts.splits += report.splits;
    entry.counts.collapses += report.collapses;
    entry.counts.flips += report.flips;
  }
  clock_.time("markers", [&] { truth_.advance(particles); });
  // Where there was no surface before, all methods begin with the same one.
  truth_.start_markers(entries_.front().tracker->mesh());
}

void Comparison::record(int frame, const RestFrame& rest, const ParticleFrame& particles) {
  clock_.time("comparison", [&] { measure_all(frame); });
  if (pictures_) clock_.time("tiles", [&] { draw(frame, rest, particles); });
}

void Comparison::measure_all(int frame) {
  const MethodMeasures measures(truth_, kReachInSpacings * scene_.particles.spacing);
  for (Entry& entry : entries_) {
    CompareRow& row = rows_.emplace_back(std::exchange(entry.counts, {}));
    row.frame = frame;
    row.method = entry.method;
    measures.add_to(row, *entry.tracker);
  }
  write_compare_csv(directory_.compare_csv(), rows_);
}

void Comparison::draw(int frame, const RestFrame& rest, const ParticleFrame& particles) {
  std::vector<SurfaceFrame> surfaces;
  for (const Entry& entry : entries_)
    surfaces.push_back(dress(entry.tracker->mesh(), truth_.particles().time, scene_.texture, rest));
  pictures_->draw(frame, surfaces, particles);
}

void Comparison::finish(const std::function<void(const std::string&)>& report) const {
  const double spacing = scene_.particles.spacing;
  const bool video = pictures_ && scene_.output.video;
  write_plots(compare_plots(scene_.name, rows_, spacing), directory_.compare_plots());
  if (pictures_) pictures_->finish(video, report);
  write_compare_markdown(
      directory_.compare_markdown(),
      {scene_.name, spacing, truth_.description(), scene_max_slip_, pictures_ != nullptr, video && have_ffmpeg()},
      rows_);
}

std::vector<std::string> Comparison::ranking() const {
  std::vector<std::string> lines = ranking_lines(rank_methods(rows_, scene_.particles.spacing));
  lines.insert(lines.begin(), std::string("ranking by texture error (lengths in particle spacings; ") + kSlipFreely +
                                  "; docs/compare.md explains the columns):");
  return lines;
}

}  // namespace flowskin::tools
