// [FMM13, Figs. 10 and 11]: the stair flow by several methods, beside the particles.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "common/bounds.h"
#include "common/errors.h"
#include "scenes/sources/make_source.h"
#include "tools/experiments/error_measures.h"
#include "tools/experiments/experiment.h"
#include "tools/pipeline/interruption.h"
#include "tools/pipeline/picture_maker.h"
#include "tools/pipeline/tracker_bridge.h"
#include "tools/render/renderer.h"
#include "tools/render/video.h"
#include "tools/textures/texture_mapping.h"
#include "tracking/material/material.h"

namespace flowskin::tools {
namespace {

constexpr int kColumns = 5;         // times in the sheet, the first one at the start
constexpr int kPictureWidth = 400;  // pixels

// One method on the way down.
struct Walker {
  std::string method;
  tracking::Tracker tracker;
  int reextractions = 0;
  std::vector<double> drifts;  // median of each frame (spacings)
  double largest_distance = 0;
  std::vector<Image> pictures;
};

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

class StairsRun {
 public:
  explicit StairsRun(const PaperRun& run)
      : run_(run),
        scene_(scene_of(run)),
        source_(scenes::make_source(scene_)),
        rest_(rest_frame(source_->state().rest_positions)),
        renderer_(scene_.render, scene_.boundaries, make_texture(scene_.texture.image, scene_.directory),
                  bounds(source_->state().positions)) {
    table_.columns = {"frame",      "time",          "method",       "vertices", "median_drift",
                      "components", "reextractions", "max_distance", "spacing"};
    for (const std::string& method : methods()) {
      tracking::TrackerSettings settings = scenes::settings_in_metres(scene_);
      settings.velocity = method;
      settings.max_slip = 0;
      settings.fairing_drags = true;  // the paper's fairing for all its methods
      walkers_.push_back({method, tracking::Tracker(settings, to_particles(source_->state())), 0, {}, 0, {}});
    }
  }

  void go() {
    for (int frame = 0; frame <= scene_.frames; ++frame) {
      if (frame > 0) advance(frame);
      if (frame == column_frame(int(times_.size()))) draw(frame);
      if (interrupted()) throw RunError("interrupted");
    }
  }

  ExperimentReport report() const;

 private:
  static scenes::Scene scene_of(const PaperRun& run) {
    scenes::Scene scene = run.scene("stairs");
    if (run.quick) scene.frames = 4, scene.tracking.edge_length /= 2;
    return scene;
  }

  std::vector<std::string> methods() const {
    std::vector<std::string> names{"normal", "total", "curvature"};
    names.insert(names.end(), run_.best_in_flow.begin(), run_.best_in_flow.end());
    return names;
  }

  int column_frame(int column) const { return int(std::lround(double(column) * scene_.frames / (kColumns - 1))); }

  void advance(int frame) {
    const double before = (frame - 1) / scene_.frame_rate, duration = 1 / scene_.frame_rate;
    const int steps = scene_.tracking.steps_per_frame;
    for (int step = 1; step <= steps; ++step) {
      source_->advance_to(before + duration * step / steps);
      const tracking::Particles particles = to_particles(source_->state());
      for (Walker& walker : walkers_) {
        walker.tracker.advance(particles);
        walker.reextractions += walker.tracker.report().reextracted;
      }
    }
    for (Walker& walker : walkers_) record(frame, walker);
  }

  void record(int frame, Walker& walker) {
    const tracking::Particles particles = to_particles(source_->state());
    const tracking::MetaballField field(particles.positions, {}, walker.tracker.settings().field);
    const double drift = median(tracking::material_drift(walker.tracker.mesh(), field, particles));
    walker.drifts.push_back(drift / scene_.particles.spacing);
    walker.largest_distance = std::max(walker.largest_distance, walker.tracker.report().max_distance);
    table_.add({frame, source_->state().time, walker.method, int(walker.tracker.mesh().positions.size()), drift,
                walker.tracker.report().components, walker.reextractions, walker.tracker.report().max_distance,
                scene_.particles.spacing});
  }

  void draw(int frame) {
    const double time = frame / scene_.frame_rate;
    times_.push_back(fmt::format("{:.2f} s", time));
    particle_pictures_.push_back(renderer_.draw(dress(source_->state(), source_->spacing(), rest_)));
    for (Walker& walker : walkers_)
      walker.pictures.push_back(renderer_.draw(dress(walker.tracker.mesh(), time, scene_.texture, rest_)));
  }

  const Walker& walker(const std::string& method) const {
    return *std::find_if(walkers_.begin(), walkers_.end(), [&](const Walker& w) { return w.method == method; });
  }
  /// In spacings, averaged over the frames.
  double drift(const std::string& method) const {
    Average average;
    for (const double drift : walker(method).drifts) average.add(drift);
    return average.mean();
  }

  const PaperRun& run_;
  scenes::Scene scene_;
  std::unique_ptr<scenes::ParticleSource> source_;
  RestFrame rest_;
  Renderer renderer_;
  std::vector<Walker> walkers_;
  std::vector<Image> particle_pictures_;
  std::vector<std::string> times_;
  ResultTable table_;
};

ExperimentReport StairsRun::report() const {
  ExperimentReport report;
  report.title = "The stair flow (Figs. 10 and 11)";
  report.setup = fmt::format(
      "`stairs.json`: {} particles, {} frames, one simulation, the program's tracker with remeshing and guard for each "
      "method. Drift: distance between the rest position that a vertex carries and that of the particles beneath it, "
      "median over the vertices, mean over the frames, in particle spacings.",
      source_->state().positions.size(), scene_.frames);
  run_.write_csv("stairs", table_, report);
  ResultTable brief;
  brief.columns = {"method", "drift (spacings)", "new extractions by the guard",
                   "largest distance to f = 0 (spacings)"};
  std::vector<std::vector<Image>> rows;
  std::vector<std::string> labels;
  for (const Walker& w : walkers_) {
    brief.add({w.method, drift(w.method), w.reextractions, w.largest_distance / scene_.particles.spacing});
    rows.push_back(w.pictures);
    labels.push_back(w.method);
  }
  rows.push_back(particle_pictures_);
  labels.emplace_back("particles");
  report.tables.emplace_back("On the stairs", brief);
  write_png(run_.out / "stairs.png", contact_sheet(rows, labels, times_, std::min(kPictureWidth, scene_.render.width)));
  report.pictures.emplace_back("Figs. 10 and 11: the surface by each method, and the particles", "stairs.png");

  Plot plot;
  plot.title = "Drift of the texture from the particles beneath";
  plot.x_label = "time (s)";
  plot.y_label = "median drift (spacings)";
  for (const Walker& w : walkers_) {
    std::vector<double> x;
    for (int frame = 1; frame <= int(w.drifts.size()); ++frame) x.push_back(frame / scene_.frame_rate);
    plot.series.push_back(run_.series(w.method, x, w.drifts));
  }
  run_.write_plot_sheet("stairs_drift", "Drift of the texture on the stairs", {"", {plot}, 1, 640, 340}, report);

  report.claims.push_back(
      {"Fig. 10", "Curvature invariance captures the surface movement better than the total velocity.",
       fmt::format("drift in spacings: normal {}, total {}, curvature {}", short_number(drift("normal")),
                   short_number(drift("total")), short_number(drift("curvature"))),
       verdict_of({drift("curvature") < drift("total")}), ""});
  report.claims.push_back(
      {"Fig. 10 (b)", "Displaced polygons appear, where the least squares end in a wrong minimum.",
       fmt::format("largest distance of a vertex to f = 0: {} spacings; new extractions by the guard: {}",
                   short_number(walker("curvature").largest_distance / scene_.particles.spacing),
                   walker("curvature").reextractions),
       verdict_of({walker("curvature").largest_distance > 0.1 * scene_.particles.spacing}),
       "The system is linear and has one minimum; a damped direct solution has no wrong one to end in."});
  for (const std::string& best : run_.best_in_flow)
    report.claims.push_back({"target", fmt::format("{} follows the fluid better than curvature invariance.", best),
                             fmt::format("drift in spacings: curvature {}, {} {}", short_number(drift("curvature")),
                                         best, short_number(drift(best))),
                             verdict_of({drift(best) < drift("curvature")}), ""});
  return report;
}

}  // namespace

ExperimentReport stairs_experiment(const PaperRun& run) {
  StairsRun stairs(run);
  stairs.go();
  return stairs.report();
}

}  // namespace flowskin::tools
