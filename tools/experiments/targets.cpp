// What this project promises on the ring of three particles [FMM13, Fig. 6], with 240 steps a revolution and RK4.
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

// The method and scene of a target, carried as far as any of its targets asks.
Ride longest_ride(const PaperRun& run, const Target& target, const scenes::Scene& scene) {
  RideSettings settings = ride_settings(scene);
  settings.velocity = target.method;
  settings.periods = 0;
  for (const Target& other : targets())
    if (other.scene == target.scene && other.method == target.method)
      settings.periods = std::max(settings.periods, other.revolutions);
  if (run.quick) settings.periods = 1;
  return take_ride(scene, start_mesh(scene), settings);
}

Claim judge(const Target& target, const Ride& ride) {
  const int reached = std::min<int>(target.revolutions, ride.last().period);
  const double error = ride.checkpoints[std::size_t(reached - 1)].errors.path;
  return {
      "target",
      fmt::format("{} on {}: path error after {} revolutions at most {} sigma ({} steps a revolution, {}, {} fairing "
                  "iterations).",
                  target.method, target.scene, target.revolutions, short_number(target.most),
                  ride.settings.steps_per_period, integrator_name(ride.settings.integrator),
                  ride.settings.fairing_iterations),
      fmt::format("{} sigma after {} revolution(s); return error {}, relative velocity error {}", short_number(error),
                  reached, short_number(ride.checkpoints[std::size_t(reached - 1)].errors.back.mean),
                  short_number(ride.checkpoints[std::size_t(reached - 1)].errors.velocity_error)),
      verdict_of({error <= target.most && reached == target.revolutions}),
      reached == target.revolutions ? "" : "Not carried that far in the reduced version."};
}

}  // namespace

ExperimentReport targets_experiment(const PaperRun& run) {
  ExperimentReport report;
  report.title = "What this project promises on the ring";
  report.setup =
      "The scenes `ring_weak.json` and `ring_strong.json` as they are. The truth is the rigid rotation; path errors "
      "are "
      "averaged over all vertices and steps.";
  ResultTable table = ride_table();
  Plot plot;
  plot.title = "Path error with 10 fairing iterations";
  plot.x_label = "revolutions";
  plot.y_label = "path error (sigma)";
  plot.log_y = true;
  std::vector<Ride> rides;
  std::vector<std::string> done;
  for (const Target& target : targets()) {
    if (std::find(run.methods.begin(), run.methods.end(), target.method) == run.methods.end()) continue;
    const std::string name = target.method + " on " + target.scene;
    auto place = std::find(done.begin(), done.end(), name);
    if (place == done.end()) {
      const scenes::Scene scene = run.scene(target.scene);
      rides.push_back(longest_ride(run, target, scene));
      add_ride(table, scene, rides.back());
      Series series{name, {}, {}};
      for (const RideCheckpoint& at : rides.back().checkpoints) {
        series.x.push_back(at.period);
        series.y.push_back(at.errors.path);
      }
      plot.series.push_back(series);
      place = done.insert(done.end(), name);
    }
    report.claims.push_back(judge(target, rides[std::size_t(place - done.begin())]));
  }
  run.write_csv("targets", table, report);
  if (!plot.series.empty())
    run.write_plot_sheet("targets", "Path error by revolutions", {"", {plot}, 1, 640, 340}, report);
  return report;
}

}  // namespace flowskin::tools
