#include "tools/pipeline/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "common/errors.h"
#include "common/quantile.h"
#include "tools/pipeline/tracker_bridge.h"
#include "tools/render/video.h"
#include "tools/report/compare_report.h"
#include "tracking/ground_truth/mesh_errors.h"
#include "tracking/material/material.h"
#include "tracking/mesh/mesh_measures.h"
#include "tracking/mesh/texture_stretch.h"

namespace flowskin::tools {
namespace {

constexpr const char* kAll = "all";
constexpr const char* kTwin = "curvature-belyaev";  // the same velocity by another formula
constexpr const char* kOthers = "other methods";    // stage of the clock
constexpr double kReachInSpacings = 2;              // of closest points

std::string joined(const std::vector<std::string>& words) {
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

tracking::TrackerSettings settings_for(const scenes::Scene& scene, const std::string& method) {
  tracking::TrackerSettings settings = tracker_settings(scene);
  settings.velocity = method;
  settings.max_slip = 0;  // shows what the method does
  return settings;
}

double relative(double error, double flow) { return flow > 0 ? std::sqrt(error / flow) : 0; }

void add_markers(const tracking::Markers& markers, const tracking::MetaballField& field,
                 const tracking::Particles& particles, CompareRow& row) {
  std::vector<double> depths, drifts;
  for (std::size_t i = 0; i < markers.ids.size(); ++i) {
    if (markers.left[i]) continue;
    depths.push_back(markers.depths[i]);
    const Vec3 rest = tracking::rest_position_at(field, particles, markers.positions[i]);
    drifts.push_back((rest - markers.rest_positions[i]).norm());
  }
  row.markers = int(depths.size());
  row.markers_left = int(markers.ids.size() - depths.size());
  row.marker_depth = quantile(depths, 0.5);
  row.marker_drift = quantile(drifts, 0.5);
}

void add_marker_errors(const tracking::MarkerErrors& errors, CompareRow& row) {
  row.texture_median = errors.texture.median;
  row.texture_p90 = errors.texture.p90;
  row.texture_rms = errors.texture.rms;
  row.texture_found = errors.texture_found;
  row.path_median = errors.path.median;
  row.path_p90 = errors.path.p90;
  row.path_rms = errors.path.rms;
  row.path_found = errors.path_found;
  row.vertex_path_median = errors.vertex_path.median;
  row.vertex_path_rms = errors.vertex_path.rms;
  row.vertices_kept = errors.vertices_kept;
}

void add_velocity_errors(const tracking::VelocityErrors& errors, CompareRow& row) {
  row.velocity_error = relative(errors.error, errors.flow);
  row.tangential_error = relative(errors.tangential_error, errors.tangential_flow);
  row.flow_speed = std::sqrt(errors.flow);
  row.tangential_speed = std::sqrt(errors.tangential_flow);
}

void add_mesh(const tracking::SurfaceMesh& mesh, CompareRow& row) {
  row.vertices = mesh.positions.size();
  row.triangles = mesh.triangles.size();
  constexpr double degrees = 180 / std::numbers::pi;
  const std::vector<double> angles = tracking::smallest_angles(mesh.positions, mesh.triangles);
  row.angle_min = degrees * quantile(angles, 0);
  row.angle_p05 = degrees * quantile(angles, 0.05);
  if (!angles.empty())
    row.angle_mean = degrees * std::accumulate(angles.begin(), angles.end(), 0.0) / double(angles.size());
  std::vector<double> stretch;
  for (const auto& triangle : tracking::texture_stretch(mesh)) stretch.push_back(triangle.largest);
  row.stretch_median = quantile(stretch, 0.5);
  row.stretch_p99 = quantile(stretch, 0.99);
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
                                   joined(known)));
    }
  }
  return methods;
}

Comparison::Comparison(const scenes::Scene& scene, const RunDirectory& directory,
                       const std::vector<std::string>& methods, const tracking::Tracker& scene_tracker,
                       const tracking::Particles& start, StageClock& clock)
    : scene_(scene), directory_(directory), truth_(scene, scene_tracker.settings(), start), clock_(clock) {
  for (const std::string& method : methods) {
    Entry& entry = entries_.emplace_back(Entry{method, nullptr, &scene_tracker, {}});
    if (method == scene_tracker.settings().velocity) continue;
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
  return fmt::format("comparing {} with {} markers that ride {}", joined(methods), truth_.markers().ids.size(),
                     truth_.description());
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

CompareRow Comparison::measure(int frame, const Entry& entry, const tracking::MetaballField& field,
                               const tracking::Flow& flow) const {
  CompareRow row = entry.counts;
  row.frame = frame;
  row.time = truth_.particles().time;
  row.method = entry.method;
  const tracking::SurfaceMesh& mesh = entry.tracker->mesh();
  row.components = entry.tracker->report().components;
  row.max_distance = entry.tracker->report().max_distance;
  add_mesh(mesh, row);
  add_marker_errors(tracking::marker_errors(mesh, truth_.markers(), kReachInSpacings * scene_.particles.spacing), row);
  add_velocity_errors(tracking::velocity_errors(mesh, flow), row);
  if (!mesh.positions.empty() && !truth_.particles().positions.empty())
    row.texture_drift = quantile(tracking::material_drift(mesh, field, truth_.particles()), 0.5);
  return row;
}

void Comparison::record(int frame, const RestFrame& rest, const ParticleFrame& particles) {
  clock_.time("comparison", [&] { measure_all(frame); });
  if (pictures_) clock_.time("tiles", [&] { draw(frame, rest, particles); });
}

void Comparison::measure_all(int frame) {
  const tracking::MetaballField field = truth_.field();
  const tracking::Flow flow = truth_.flow();
  CompareRow of_markers;
  add_markers(truth_.markers(), field, truth_.particles(), of_markers);
  for (Entry& entry : entries_) {
    CompareRow& row = rows_.emplace_back(measure(frame, entry, field, flow));
    row.markers = of_markers.markers;
    row.markers_left = of_markers.markers_left;
    row.marker_depth = of_markers.marker_depth;
    row.marker_drift = of_markers.marker_drift;
    entry.counts = {};
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
  write_compare_markdown(directory_.compare_markdown(),
                         {scene_.name, spacing, truth_.description(), pictures_ != nullptr, video && have_ffmpeg()},
                         rows_);
}

std::vector<std::string> Comparison::ranking() const {
  std::vector<std::string> lines = ranking_lines(rank_methods(rows_, scene_.particles.spacing));
  lines.insert(lines.begin(),
               "ranking by texture error (lengths in particle spacings; docs/compare.md explains the columns):");
  return lines;
}

}  // namespace flowskin::tools
