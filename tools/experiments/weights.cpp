// How much the total velocity should weigh against the rows of K and H: error against weight.
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "tools/experiments/experiment.h"
#include "tools/experiments/test_flows.h"
#include "tracking/velocity/curvature_velocity.h"

namespace flowskin::tools {
namespace {

constexpr double kMostInRotation = 0.45, kMostElsewhere = 0.8;  // relative RMS velocity error
constexpr double kBlownUp = 3;

/// Worst relative RMS error over the bodies and radii.
double worst_error(const tracking::CurvatureWeights& weights, const TestFlow& flow) {
  const auto method = tracking::make_curvature_velocity(weights);
  double worst = 0;
  for (const FlowBody& body : {test_ball(), test_block()}) {
    for (const double radius : {2.0, 3.0})
      worst = std::max(worst, velocity_errors(*method, body, radius, flow).relative_rms);
  }
  return worst;
}

/// One line a flow.
Plot error_plot(const std::string& title, const std::string& label, const std::vector<double>& values,
                tracking::CurvatureWeights (*weights)(double), const std::string& kind, ResultTable& table) {
  Plot plot;
  plot.title = title;
  plot.x_label = label;
  plot.y_label = "relative RMS velocity error";
  plot.log_x = plot.log_y = true;
  for (const TestFlow& flow : test_flows()) {
    if (flow.name == "translation") continue;  // exact at every weight
    Series series;
    series.name = flow.name;
    for (const double value : values) {
      series.x.push_back(value);
      series.y.push_back(worst_error(weights(value), flow));
      table.add({kind, value, flow.name, series.y.back()});
    }
    plot.series.push_back(series);
  }
  return plot;
}

Claim defaults_hold() {
  std::string measured;
  std::vector<bool> holds;
  for (const TestFlow& flow : test_flows()) {
    const double error = worst_error({}, flow);
    measured += fmt::format("{}{} {}", measured.empty() ? "" : ", ", flow.name, short_number(error));
    holds.push_back(error < (flow.name == "rotation" ? kMostInRotation : kMostElsewhere));
  }
  return {"target", "curvature never blows up: at most 0.8 on every test flow, 0.45 in rotation (relative RMS error).",
          measured, verdict_of(holds), ""};
}

Claim undamped_blows_up() {
  const double error = worst_error({1e-6, 0}, test_flow("shear"));
  return {"target", "Without damping it exceeds 3 in shear.", fmt::format("{} at the weight 1e-6", short_number(error)),
          verdict_of({error > kBlownUp}), ""};
}

}  // namespace

ExperimentReport weights_experiment(const PaperRun& run) {
  std::vector<double> constant = {1e-4, 1e-3, 0.01, 0.03, 0.1, 0.3, 1, 3, 10},
                      factors = {0.5, 1, 2, 4, 6, 8, 12, 16, 32};
  if (run.quick) constant = {0.01, 1}, factors = {2, 8};
  ExperimentReport report;
  report.title = "The weight of the total velocity in `curvature`";
  report.setup =
      "Bodies of about 350 jittered particles (a ball and a block, effective radius 2 and 3 spacings) in the test "
      "flows of "
      "docs/velocity_methods.md; the worst of the four. Left: one weight w everywhere; right, what the method does: w "
      "= "
      "3e-4 + factor * rho, where rho is the share of the change of gradient and Hessian that no spin explains.";
  ResultTable table;
  table.columns = {"kind", "value", "flow", "relative_rms_error"};
  const std::vector<Plot> plots = {error_plot(
                                       "one weight everywhere", "weight w", constant,
                                       [](double w) {
                                         return tracking::CurvatureWeights{w, 0};
                                       },
                                       "constant", table),
                                   error_plot(
                                       "weight by the rigidity of the motion", "factor (default 8)", factors,
                                       [](double f) {
                                         return tracking::CurvatureWeights{tracking::CurvatureWeights{}.least, f};
                                       },
                                       "factor", table)};
  run.write_csv("weights", table, report);
  report.claims = {defaults_hold(), undamped_blows_up()};
  run.write_plot_sheet("weights", "Error of `curvature` against the weight", {"", plots, 2, 520, 380}, report);
  return report;
}

}  // namespace flowskin::tools
