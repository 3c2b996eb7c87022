// Step counts: how fast the error of the time integration falls.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/experiments/experiment.h"
#include "tools/experiments/ride_table.h"

namespace flowskin::tools {
namespace {

using tracking::Integrator;

constexpr double kFloor = 3e-7;  // sigma: near the tolerance of the projection and below it, no order can be asked for
constexpr double kTolerance = 0.3;  // of an order

constexpr struct {
  Integrator integrator;
  double order;
} kIntegrators[] = {{Integrator::euler, 1}, {Integrator::rk2, 2}, {Integrator::rk4, 4}};

// A method on a body whose true velocity it knows, so that only the time step is wrong.
struct Case {
  std::string scene, method;
  bool without_spin;
};

std::vector<Case> cases(const PaperRun& run) {
  return {{"circling_ball", "total", true}, {"ring_strong", run.best, false}, {"ring_weak", run.best, false}};
}

std::vector<int> step_counts(const PaperRun& run) {
  return run.quick ? std::vector<int>{10, 20, 40} : std::vector<int>{15, 30, 60, 120, 240, 480};
}

double error_of(const Ride& ride, const Case& what) {
  return what.without_spin ? ride.last().unspinning.path : ride.last().errors.path;
}

std::vector<Ride> measure(const PaperRun& run, const Case& what, const scenes::Scene& scene) {
  std::vector<RideSettings> all;
  for (const auto& [integrator, order] : kIntegrators)
    for (const int steps : step_counts(run)) all.push_back({what.method, integrator, steps, 1, 0});
  return take_rides(scene, start_mesh(scene), all);
}

// Adds the row of each integrator to the table, and the claim about the orders.
Claim judge(const PaperRun& run, const Case& what, const std::vector<Ride>& rides, ResultTable& table) {
  std::vector<bool> holds;
  std::string measured;
  for (const auto& [integrator, order] : kIntegrators) {
    std::vector<double> errors;
    for (const Ride& ride : rides)
      if (ride.settings.integrator == integrator) errors.push_back(error_of(ride, what));
    const double fitted = convergence_order(step_counts(run), errors, kFloor);
    holds.push_back(std::abs(fitted - order) <= kTolerance);
    measured += fmt::format("{}{} {:.2f}", measured.empty() ? "" : ", ", integrator_name(integrator), fitted);
    std::vector<Cell> row{what.scene, what.method, integrator_name(integrator)};
    for (const double error : errors) row.emplace_back(error);
    row.emplace_back(fitted);
    table.add(std::move(row));
  }
  return {"target",
          fmt::format("The error falls with the order of the integrator: 1, 2, 4 ({}, {}).", what.scene, what.method),
          "fitted orders: " + measured, verdict_of(holds),
          "Where the method's own velocity is wrong, no time step makes the error smaller."};
}

Plot error_plot(const Case& what, const std::vector<Ride>& rides) {
  Plot plot;
  plot.title = fmt::format("{}, {}", what.scene, what.method);
  plot.x_label = "steps per revolution";
  plot.y_label = "path error (sigma)";
  plot.log_x = plot.log_y = true;
  plot.note = fmt::format("orders are fitted to errors above {}", short_number(kFloor));
  for (const auto& [integrator, order] : kIntegrators) {
    Series series;
    series.name = fmt::format("{} (order {:g})", integrator_name(integrator), order);
    for (const Ride& ride : rides) {
      if (ride.settings.integrator != integrator) continue;
      series.x.push_back(ride.settings.steps_per_period);
      series.y.push_back(error_of(ride, what));
    }
    plot.series.push_back(series);
  }
  return plot;
}

}  // namespace

ExperimentReport convergence_experiment(const PaperRun& run) {
  ExperimentReport report;
  report.title = "Step counts and order of convergence";
  report.setup = fmt::format(
      "One revolution without fairing by Euler's method, the midpoint rule (rk2) and RK4; path error in sigma, against "
      "the motion without spin for the ball and the rotation for the rings. The order is fitted over errors above {}.",
      short_number(kFloor));
  ResultTable rides_table = ride_table(), table;
  PlotSheet sheet;
  sheet.title = "Order of convergence";
  sheet.columns = 3;
  sheet.panel_width = 380;
  table.columns = {"scene", "method", "integrator"};
  for (const int steps : step_counts(run)) table.columns.push_back(fmt::format("{} steps", steps));
  table.columns.emplace_back("order");
  for (const Case& what : cases(run)) {
    const scenes::Scene scene = run.scene(what.scene);
    const std::vector<Ride> rides = measure(run, what, scene);
    for (const Ride& ride : rides) add_ride_end(rides_table, scene, ride, what.without_spin);
    report.claims.push_back(judge(run, what, rides, table));
    sheet.plots.push_back(error_plot(what, rides));
  }
  run.write_csv("convergence", rides_table, report);
  run.write_plot_sheet("convergence", "Path error by steps per revolution", sheet, report);
  report.tables.emplace_back("Path error (sigma) by steps per revolution", table);
  return report;
}

}  // namespace flowskin::tools
