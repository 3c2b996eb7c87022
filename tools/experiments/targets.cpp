// What this project promises on the ring of three particles [FMM13, Fig. 6], with 240 steps per revolution and RK4.
#include <fmt/format.h>

#include <algorithm>

#include "tools/experiments/experiment.h"
#include "tools/experiments/ride_table.h"

namespace flowskin::tools {
namespace {

// A promise: path error after some revolutions, with the scene's own steps and fairing.
struct Target {
  std::string scene, method;
  int revolutions;
  double most;  ///< sigma
};

const std::vector<Target>& targets() {
  static const std::vector<Target> all{{"ring_weak", "rigid-global", 3, 1e-3},
                                       {"ring_weak", "rigid-global", 30, 1e-2},
                                       {"ring_strong", "rigid", 3, 1e-4}};
  return all;
}

// The method and scene of a target with variable springs, carried as far as any of its targets asks; for comparison
// with constant springs and without fairing, as far as the scene goes.
std::vector<Ride> rides_for(const PaperRun& run, const Target& target, const scenes::Scene& scene) {
  RideSettings variable = ride_settings(scene);
  variable.velocity = target.method;
  RideSettings constant = variable, unfaired = variable;
  variable.variable_springs = true;
  constant.variable_springs = false;
  unfaired.fairing_iterations = 0;
  for (const Target& other : targets())
    if (other.scene == target.scene && other.method == target.method)
      variable.periods = std::max(variable.periods, other.revolutions);
  if (run.quick) variable.periods = constant.periods = unfaired.periods = 1;
  return take_rides(scene, start_mesh(scene), {variable, constant, unfaired});
}

Claim judge(const Target& target, const std::vector<Ride>& rides) {
  const Ride &ride = rides[0], &constant = rides[1], &unfaired = rides[2];
  const int reached = std::min<int>(target.revolutions, ride.last().period);
  const RideErrors& errors = ride.checkpoints[std::size_t(reached - 1)].errors;
  const RideSettings& settings = ride.settings;
  const bool holds = errors.path <= target.most && reached == target.revolutions;
  std::string reason;
  if (reached < target.revolutions) reason = "Not carried that far in the reduced version.";
  if (!holds && unfaired.last().errors.path <= target.most)
    reason += "Without fairing the target is met: what is left is the drift of the fairing, not of the velocity.";
  return {"target",
          fmt::format(
              "{} on {}: path error after {} revolutions at most {} sigma ({} steps per revolution, {}, {} iterations "
              "of the fairing with variable springs).",
              target.method, target.scene, target.revolutions, short_number(target.most), settings.steps_per_period,
              integrator_name(settings.integrator), settings.fairing_iterations),
          fmt::format("{} sigma after {} revolution(s); return error {}, relative velocity error {}; path error "
                      "after {} revolution(s) with constant springs {}, without fairing {}",
                      short_number(errors.path), reached, short_number(errors.back.mean),
                      short_number(errors.velocity_error), constant.last().period,
                      short_number(constant.last().errors.path), short_number(unfaired.last().errors.path)),
          verdict_of({holds}), reason};
}

std::string fairing_name(const RideSettings& settings) {
  if (settings.fairing_iterations == 0) return "no fairing";
  return settings.variable_springs ? "variable springs" : "constant springs";
}

Series path_errors(const std::string& name, const Ride& ride) {
  Series series{name, {}, {}};
  for (const RideCheckpoint& at : ride.checkpoints) {
    series.x.push_back(at.period);
    series.y.push_back(at.errors.path);
  }
  return series;
}

}  // namespace

ExperimentReport targets_experiment(const PaperRun& run) {
  ExperimentReport report;
  report.title = "What this project promises on the ring";
  report.setup =
      "The scenes `ring_weak.json` and `ring_strong.json`, with variable springs. The truth is the rigid rotation; "
      "path errors "
      "are "
      "averaged over all vertices and steps.";
  ResultTable table = ride_table();
  Plot plot;
  plot.title = "Path error, 240 steps per revolution";
  plot.x_label = "revolutions";
  plot.y_label = "path error (sigma)";
  plot.log_y = true;
  std::vector<std::pair<std::string, std::vector<Ride>>> done;
  for (const Target& target : targets()) {
    if (std::find(run.methods.begin(), run.methods.end(), target.method) == run.methods.end()) continue;
    const std::string name = target.method + " on " + target.scene;
    if (done.empty() || done.back().first != name) {
      const scenes::Scene scene = run.scene(target.scene);
      done.emplace_back(name, rides_for(run, target, scene));
      for (const Ride& ride : done.back().second) {
        add_ride(table, scene, ride);
        plot.series.push_back(path_errors(fmt::format("{}, {}", name, fairing_name(ride.settings)), ride));
      }
    }
    report.claims.push_back(judge(target, done.back().second));
  }
  run.write_csv("targets", table, report);
  if (!plot.series.empty())
    run.write_plot_sheet("targets", "Path error by revolutions", {"", {plot}, 1, 640, 340}, report);
  return report;
}

}  // namespace flowskin::tools
