#include "tools/pipeline/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "common/errors.h"
#include "tools/pipeline/method_measures.h"
#include "tools/pipeline/tracker_bridge.h"
#include "tools/render/video.h"
#include "tools/report/compare_report.h"

namespace flowskin::tools {
namespace {

constexpr const char* kAll = "all";
constexpr const char* kTwin = "curvature-belyaev";  // the same velocity by another formula
constexpr const char* kOthers = "other methods";    // stage of the clock
constexpr double kReachInSpacings = 2;              // of closest points

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

/// The words between the commas; none of an empty text.
std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> words;
  for (std::size_t begin = 0; begin < list.size() || (begin > 0 && begin == list.size());) {
    const std::size_t comma = std::min(list.find(',', begin), list.size());
    words.push_back(list.substr(begin, comma - begin));
    begin = comma + 1;
  }
  return words;
}

/// Those of the scene, but for the method, and with a texture that slips freely: one that is held on the particles
/// would show what they do, not what the method does.
tracking::TrackerSettings settings_for(const scenes::Scene& scene, const std::string& method) {
  tracking::TrackerSettings settings = scenes::settings_in_metres(scene);
  settings.velocity = method;
  settings.max_slip = 0;
  return settings;
}

/// Whether the mesh of the scene's own run is the one that this method is to be judged by.
bool serves_for(const std::string& method, const tracking::TrackerSettings& settings) {
  return method == settings.velocity && settings.max_slip == 0;
}

}  // namespace

std::vector<std::string> methods_to_compare(const std::string& list) {
  std::vector<std::string> known, methods;
  for (const auto& method : tracking::velocity_methods()) known.push_back(method.name);
  const auto add = [&methods](const std::string& name) {
    if (std::find(methods.begin(), methods.end(), name) == methods.end()) methods.push_back(name);
  };
  for (const std::string& name : split(list)) {
    if (name == kAll) {
      for (const std::string& method : known)
        if (method != kTwin) add(method);
    } else if (std::find(known.begin(), known.end(), name) != known.end()) {
      add(name);
    } else {
      throw InputError(fmt::format("--compare: there is no velocity method \"{}\"; expected some of {}, or all", name,
                                   listed(known)));
    }
  }
  return methods;
}

Comparison::Comparison(const scenes::Scene& scene, const RunDirectory& directory,
                       const std::vector<std::string>& methods, const tracking::Tracker& scene_tracker,
                       const tracking::Particles& start, StageClock& clock)
    : scene_(scene),
      directory_(directory),
      scene_max_slip_(scene_tracker.settings().max_slip),
      truth_(scene, scene_tracker.settings(), start),
      clock_(clock) {
  for (const std::string& method : methods) {
    Entry& entry = entries_.emplace_back(Entry{method, nullptr, &scene_tracker, {}});
    if (serves_for(method, scene_tracker.settings())) continue;
    clock_.time(kOthers, [&] { entry.own = std::make_unique<tracking::Tracker>(settings_for(scene, method), start); });
    entry.tracker = entry.own.get();
  }
  truth_.start_markers(scene_tracker.mesh());
}

void Comparison::make_pictures(const Image& texture, const sph::Box& fluid) {
  std::vector<std::string> methods;
  for (const Entry& entry : entries_) methods.push_back(entry.method);
  pictures_ = std::make_unique<ComparisonPictures>(directory_, scene_, texture, fluid, methods);
}

std::string Comparison::description() const {
  std::vector<std::string> methods;
  for (const Entry& entry : entries_) methods.push_back(entry.method);
  std::string text = fmt::format("comparing {} with {} markers that ride {}; {}", listed(methods),
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
