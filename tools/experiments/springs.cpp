// [FMM13, 5]: would variable spring constants in the fairing prevent the drift of Fig. 6?
#include <fmt/format.h>

#include "tools/experiments/experiment.h"
#include "tools/experiments/ride_table.h"

namespace flowskin::tools {
namespace {

constexpr int kSpringIterations = 10;  // [FMM13, Fig. 6]

// One overlap; rides of constant and variable springs alternate.
struct SpringRing {
  std::string name;
  scenes::Scene scene;
  std::vector<Ride> rides;

  double path_error(const std::string& method, int iterations, bool variable) const {
    for (const Ride& ride : rides)
      if (ride.settings.velocity == method && ride.settings.fairing_iterations == iterations &&
          ride.settings.variable_springs == variable)
        return ride.last().errors.path;
    throw std::logic_error("no ride with " + method);
  }
};

std::vector<int> spring_iterations(const PaperRun& run) {
  return run.quick ? std::vector<int>{kSpringIterations} : std::vector<int>{1, kSpringIterations, 30};
}

std::vector<std::string> shown_methods(const PaperRun& run) {
  std::vector<std::string> methods{"curvature"};
  if (run.best != "curvature") methods.push_back(run.best);
  return methods;
}

SpringRing measure_springs(const PaperRun& run, const std::string& name) {
  SpringRing ring{name, run.scene("ring_" + name), {}};
  RideSettings settings = ride_settings(ring.scene);
  settings.steps_per_period = run.quick ? 12 : 60;
  if (run.quick) settings.periods = 1;
  std::vector<RideSettings> all;
  for (const std::string& method : shown_methods(run)) {
    for (const int iterations : spring_iterations(run)) {
      for (const bool variable : {false, true}) {
        settings.velocity = method;
        settings.fairing_iterations = iterations;
        settings.variable_springs = variable;
        all.push_back(settings);
      }
    }
  }
  ring.rides = take_rides(ring.scene, start_mesh(ring.scene), all);
  return ring;
}

Claim less_drift(const std::vector<SpringRing>& rings, const std::string& method) {
  std::vector<bool> holds;
  std::string measured;
  for (const SpringRing& ring : rings) {
    const double constant = ring.path_error(method, kSpringIterations, false),
                 variable = ring.path_error(method, kSpringIterations, true);
    holds.push_back(variable < constant);
    measured += fmt::format("{}{} overlap: constant {}, variable {}", measured.empty() ? "" : "; ", ring.name,
                            short_number(constant), short_number(variable));
  }
  return {
      "Sec. 5", fmt::format("Variable spring constants in the fairing reduce the drift of Fig. 6 ({}).", method),
      "path error in sigma, 10 iterations: " + measured, verdict_of(holds),
      "The springs are soft where the field determines the velocity well; they cannot mend a velocity that is wrong "
      "where the field is silent."};
}

Plot error_plot(const PaperRun& run, const SpringRing& ring) {
  Plot plot;
  plot.title = ring.name + " overlap";
  plot.x_label = "fairing iterations";
  plot.y_label = "path error (sigma)";
  plot.log_y = true;
  for (const std::string& method : shown_methods(run)) {
    for (const bool variable : {false, true}) {
      Series series{fmt::format("{}, {} springs", method, variable ? "variable" : "constant"), {}, {}};
      for (const int iterations : spring_iterations(run)) {
        series.x.push_back(iterations);
        series.y.push_back(ring.path_error(method, iterations, variable));
      }
      plot.series.push_back(series);
    }
  }
  return plot;
}

}  // namespace

ExperimentReport springs_experiment(const PaperRun& run) {
  std::vector<SpringRing> rings;
  for (const char* name : {"strong", "medium", "weak"}) rings.push_back(measure_springs(run, name));
  ExperimentReport report;
  report.title = "Variable spring constants (Sec. 5)";
  const RideSettings& settings = rings.front().rides.front().settings;
  report.setup = fmt::format(
      "The rings of Figs. 6 and 7, {} revolution(s) of {} steps ({}), with springs of one constant, as in the paper, "
      "and "
      "with springs that are soft where the field determines the velocity well (docs/fairing.md).",
      settings.periods, settings.steps_per_period, integrator_name(settings.integrator));
  ResultTable rides = ride_table(), brief;
  brief.columns = {"overlap", "method", "fairing iterations", "path error, constant (sigma)",
                   "path error, variable (sigma)"};
  PlotSheet sheet;
  sheet.title = "Drift with constant and variable springs";
  sheet.columns = int(rings.size());
  sheet.panel_width = 380;
  for (const SpringRing& ring : rings) {
    for (const Ride& ride : ring.rides) add_ride_end(rides, ring.scene, ride);
    for (const std::string& method : shown_methods(run))
      for (const int iterations : spring_iterations(run))
        brief.add({ring.name, method, iterations, ring.path_error(method, iterations, false),
                   ring.path_error(method, iterations, true)});
    sheet.plots.push_back(error_plot(run, ring));
  }
  run.write_csv("springs", rides, report);
  run.write_plot_sheet("springs", "Path error with constant and variable springs", sheet, report);
  report.tables.emplace_back("Drift by springs", brief);
  for (const std::string& method : shown_methods(run)) report.claims.push_back(less_drift(rings, method));
  return report;
}

}  // namespace flowskin::tools
