// [FMM13, Figs. 6 and 7]: three particles on a circle, three revolutions.
#include <fmt/format.h>

#include <stdexcept>

#include "tools/experiments/experiment.h"
#include "tools/experiments/ride_table.h"

namespace flowskin::tools {
namespace {

constexpr int kPaperIterations = 10;  // [FMM13, Fig. 6]
constexpr const char* kBlind =
    "The return error is blind to a mesh that never turns, and then it rewards being wrong everywhere: see the path "
    "error.";
constexpr const char* kSilent =
    "Where one particle alone covers the surface, spin leaves no trace in the field: with weak overlap that is a third "
    "of "
    "it. No method that looks at one vertex at a time can be right there, and the fairing spreads the error.";

// One amount of overlap.
struct Ring {
  std::string name;  ///< "strong"
  scenes::Scene scene;
  tracking::SurfaceMesh start;
  std::vector<Ride> rides;

  const Ride& ride(const std::string& method, int iterations) const {
    for (const Ride& ride : rides)
      if (ride.settings.velocity == method && ride.settings.fairing_iterations == iterations) return ride;
    throw std::logic_error("no ride with " + method);
  }
  const RideErrors& errors(const std::string& method, int iterations = kPaperIterations) const {
    return ride(method, iterations).last().errors;
  }
};

std::vector<int> iteration_counts(const PaperRun& run) {
  return run.quick ? std::vector<int>{0, kPaperIterations} : std::vector<int>{0, 1, 5, kPaperIterations, 20, 50};
}

int steps_a_revolution(const PaperRun& run) { return run.quick ? 12 : 60; }

Ring measure(const PaperRun& run, const std::string& name) {
  Ring ring;
  ring.name = name;
  ring.scene = run.scene("ring_" + name);
  ring.start = start_mesh(ring.scene);
  RideSettings settings = ride_settings(ring.scene);
  settings.steps_per_period = steps_a_revolution(run);
  if (run.quick) settings.periods = 1;
  std::vector<RideSettings> all;
  for (const std::string& method : run.methods) {
    for (const int iterations : iteration_counts(run)) {
      settings.velocity = method;
      settings.fairing_iterations = iterations;
      all.push_back(settings);
    }
  }
  ring.rides = take_rides(ring.scene, ring.start, all);
  return ring;
}

std::string numbers(const std::vector<Ring>& rings, const std::vector<std::string>& methods,
                    double (*value)(const RideErrors&)) {
  std::string text;
  for (const Ring& ring : rings) {
    text += (text.empty() ? "" : "; ") + ring.name + " overlap:";
    for (const std::string& method : methods)
      text += fmt::format("{} {} {}", method == methods.front() ? "" : ",", method,
                          short_number(value(ring.errors(method))));
  }
  return text;
}

double velocity_error(const RideErrors& errors) { return errors.velocity_error; }
double path_error(const RideErrors& errors) { return errors.path; }
double return_error(const RideErrors& errors) { return errors.back.mean; }

Claim normal_stays(const std::vector<Ring>& rings) {
  std::vector<bool> holds;
  for (const Ring& ring : rings) holds.push_back(ring.errors("normal").velocity_error > 0.8);
  return {"Fig. 6 (b)", "With the normal velocity the vertices hardly follow the rotation at all.",
          "relative velocity error (1: as wrong as not moving): " + numbers(rings, {"normal"}, velocity_error),
          verdict_of(holds), ""};
}

Claim less_drift(const std::vector<Ring>& rings, const char* measure, double (*value)(const RideErrors&),
                 const std::string& reason) {
  std::vector<bool> holds;
  for (const Ring& ring : rings) holds.push_back(value(ring.errors("curvature")) < value(ring.errors("total")));
  return {"Fig. 6 (c, d)", fmt::format("Curvature invariance reduces the drift of the total velocity ({}).", measure),
          "sigma, 10 iterations: " + numbers(rings, {"total", "curvature"}, value), verdict_of(holds), reason};
}

Claim better_at_few(const PaperRun& run, const std::vector<Ring>& rings, const char* measure,
                    double (*value)(const RideErrors&), const std::string& reason) {
  std::vector<bool> holds;
  std::string text;
  for (const Ring& ring : rings) {
    int better = 0;
    const std::vector<int> counts = iteration_counts(run);
    for (const int iterations : counts) {
      holds.push_back(value(ring.errors("curvature", iterations)) < value(ring.errors("total", iterations)));
      better += holds.back();
    }
    text += fmt::format("{}{} overlap: at {} of {} numbers of iterations", text.empty() ? "" : "; ", ring.name, better,
                        counts.size());
  }
  return {"Fig. 7",
          fmt::format("Curvature invariance is more accurate than the total velocity even with few iterations ({}).",
                      measure),
          "curvature is better with " + text, verdict_of(holds), reason};
}

Claim order_of_methods(const std::vector<Ring>& rings) {
  std::vector<bool> holds;
  for (const Ring& ring : rings) {
    const double normal = velocity_error(ring.errors("normal")), total = velocity_error(ring.errors("total")),
                 curvature = velocity_error(ring.errors("curvature"));
    holds.push_back(curvature < total);
    holds.push_back(total < normal);
  }
  return {"target", "In relative velocity error curvature beats total, and total beats normal.",
          numbers(rings, {"normal", "total", "curvature"}, velocity_error), verdict_of(holds),
          "On strongly overlapping particles the body is almost round: the total velocity damps what no translation "
          "explains and ends near the normal velocity, which has no tangential part to be wrong."};
}

void add_tables(const PaperRun& run, const std::vector<Ring>& rings, ExperimentReport& report) {
  constexpr struct {
    const char* caption;
    double (*value)(const RideErrors&);
  } kTables[] = {{"Path error (sigma), by fairing iterations", path_error},
                 {"Return error (sigma), the paper's measure, by fairing iterations", return_error}};
  for (const auto& [caption, value] : kTables) {
    ResultTable table;
    table.columns = {"overlap", "method"};
    for (const int iterations : iteration_counts(run)) table.columns.push_back(std::to_string(iterations));
    for (const Ring& ring : rings) {
      for (const std::string& method : run.methods) {
        std::vector<Cell> row{ring.name, method};
        for (const int iterations : iteration_counts(run)) row.emplace_back(value(ring.errors(method, iterations)));
        table.add(std::move(row));
      }
    }
    report.tables.emplace_back(caption, table);
  }
}

Plot error_plot(const PaperRun& run, const Ring& ring, const std::string& measure, double (*value)(const RideErrors&)) {
  Plot plot;
  plot.title = ring.name + " overlap";
  plot.x_label = "fairing iterations";
  plot.y_label = measure + " (sigma)";
  plot.log_y = true;
  for (const std::string& method : run.methods) {
    std::vector<double> x, y;
    for (const int iterations : iteration_counts(run)) {
      x.push_back(iterations);
      y.push_back(value(ring.errors(method, iterations)));
    }
    plot.series.push_back(run.series(method, x, y));
  }
  return plot;
}

void plot_errors(const PaperRun& run, const std::vector<Ring>& rings, ExperimentReport& report) {
  PlotSheet sheet;
  sheet.title = "Three particles on a circle, error by fairing iterations";
  sheet.columns = int(rings.size());
  sheet.panel_width = 380;
  for (const Ring& ring : rings) sheet.plots.push_back(error_plot(run, ring, "return error", return_error));
  for (const Ring& ring : rings) sheet.plots.push_back(error_plot(run, ring, "path error", path_error));
  run.write_plot_sheet("ring", "Fig. 7: error by the number of fairing iterations", sheet, report);

  Plot bars;
  bars.title = "Relative velocity error, 10 fairing iterations";
  bars.y_label = "RMS |v - v_true| / RMS |v_true|";
  for (const Ring& ring : rings) bars.categories.push_back(ring.name + " overlap");
  for (const std::string& method : run.methods) {
    std::vector<double> heights;
    for (const Ring& ring : rings) heights.push_back(velocity_error(ring.errors(method)));
    bars.series.push_back(run.series(method, {}, heights));
  }
  run.write_plot_sheet("ring_velocity", "Relative velocity error by overlap", {"", {bars}, 1, 640, 320}, report);
}

void draw(const PaperRun& run, const Ring& ring, ExperimentReport& report) {
  std::vector<Ride> shown;
  for (const std::string& method : {std::string("normal"), std::string("total"), std::string("curvature"), run.best})
    if (shown.empty() || shown.back().settings.velocity != method) shown.push_back(ring.ride(method, kPaperIterations));
  const std::string file = "ring_" + ring.name + ".png";
  write_png(run.out / file, ride_sheet(ring.scene, ring.start, shown, 0.5));
  report.pictures.emplace_back(
      fmt::format("Fig. 6 with {} overlap: the mesh after {} revolution(s), 10 fairing iterations", ring.name,
                  shown.front().last().period),
      file);
}

}  // namespace

ExperimentReport ring_experiment(const PaperRun& run) {
  std::vector<Ring> rings;
  for (const char* name : {"strong", "medium", "weak"}) rings.push_back(measure(run, name));

  ExperimentReport report;
  report.title = "Three particles on a circle (Figs. 6 and 7)";
  const RideSettings& settings = rings.front().rides.front().settings;
  report.setup = fmt::format(
      "`ring_strong.json` (R = 0.3 sigma, T = 0.6; {} vertices), `ring_medium.json` (0.4, 0.4; {}), `ring_weak.json` "
      "(0.5, 0.2; {}): {} revolution(s) of {} steps ({}), for each method and number of fairing iterations. The truth "
      "is the rigid rotation. `simulation` and `hybrid` fit a flow to the velocities of the particles in reach; one to "
      "three particles do not determine one, so they cannot do well here.",
      rings[0].start.positions.size(), rings[1].start.positions.size(), rings[2].start.positions.size(),
      settings.periods, settings.steps_per_period, integrator_name(settings.integrator));
  ResultTable table = ride_table();
  for (const Ring& ring : rings)
    for (const Ride& ride : ring.rides) add_ride(table, ring.scene, ride);
  run.write_csv("ring", table, report);
  add_tables(run, rings, report);
  report.claims = {normal_stays(rings),
                   less_drift(rings, "return error, the paper's measure", return_error, kBlind),
                   less_drift(rings, "path error", path_error, kSilent),
                   better_at_few(run, rings, "return error", return_error, kBlind),
                   better_at_few(run, rings, "path error", path_error, kSilent),
                   order_of_methods(rings)};
  plot_errors(run, rings, report);
  for (const Ring& ring : rings) draw(run, ring, report);
  return report;
}

}  // namespace flowskin::tools
