// [FMM13, Fig. 2]: a particle moves along a line.
#include <fmt/format.h>

#include <algorithm>

#include "tools/experiments/experiment.h"
#include "tools/experiments/ride_table.h"

namespace flowskin::tools {
namespace {

constexpr double kExact = 1e-6;   // sigma: an error below this is that of the projection
constexpr double kBroken = 0.25;  // RMS strain of the edges above which the mesh counts as broken up

Claim normal_breaks_up(const Ride& normal) {
  const RideCheckpoint& end = normal.last();
  return {"Fig. 2 (a)",
          "With the normal velocity the shape breaks up: vertices whose normal is across the motion stay behind.",
          fmt::format("vertices are {} sigma from their material on average, {} at most; RMS edge strain {}",
                      short_number(end.errors.end.mean), short_number(end.errors.end.max), short_number(end.strain)),
          verdict_of({end.strain > kBroken, end.errors.end.mean > 0.1}), ""};
}

Claim shape_kept(const Ride& total, const Ride& curvature) {
  return {"Fig. 2 (b, c)", "The total velocity and curvature invariance keep the shape.",
          fmt::format("largest error: total {} sigma, curvature {} sigma", short_number(total.last().errors.end.max),
                      short_number(curvature.last().errors.end.max)),
          verdict_of({total.last().errors.end.max < kExact, curvature.last().errors.end.max < kExact}), ""};
}

Claim same_result(const Ride& total, const Ride& curvature, double sigma) {
  const double apart = distances(total.last().positions, curvature.last().positions).max / sigma;
  return {"Fig. 2 (b, c)", "Both generate the same result in a translation.",
          fmt::format("largest distance between the two meshes: {} sigma", short_number(apart)),
          verdict_of({apart < kExact}), ""};
}

}  // namespace

ExperimentReport translation_experiment(const PaperRun& run) {
  const scenes::Scene scene = run.scene("translation");
  const tracking::SurfaceMesh start = start_mesh(scene);
  RideSettings settings = ride_settings(scene);
  if (run.quick) settings.steps_per_period /= 4;
  std::vector<RideSettings> all;
  for (const std::string& method : run.methods) {
    all.push_back(settings);
    all.back().velocity = method;
  }
  const std::vector<Ride> rides = take_rides(scene, start, all);

  ExperimentReport report;
  report.title = "Translation of a particle (Fig. 2)";
  report.setup = fmt::format(
      "`translation.json`: one particle moves {} sigma along a line in {} steps ({}), {} fairing iterations, {} "
      "vertices. "
      "The truth is the translation.",
      short_number(scene.particles.motion.velocity.norm() * MaterialMotion(scene).period() /
                   MaterialMotion(scene).field_settings().radius),
      settings.steps_per_period, integrator_name(settings.integrator), settings.fairing_iterations,
      start.positions.size());
  ResultTable table = ride_table();
  for (const Ride& ride : rides) add_ride_end(table, scene, ride);
  run.write_csv("translation", table, report);

  const Ride &normal = ride_of(rides, "normal"), &total = ride_of(rides, "total"),
             &curvature = ride_of(rides, "curvature");
  report.claims = {normal_breaks_up(normal), shape_kept(total, curvature),
                   same_result(total, curvature, MaterialMotion(scene).field_settings().radius)};
  ResultTable brief;
  brief.columns = {"method", "mean error (sigma)", "largest error (sigma)", "velocity error", "edge strain"};
  for (const Ride& ride : rides)
    brief.add({ride.settings.velocity, ride.last().errors.end.mean, ride.last().errors.end.max,
               ride.last().errors.velocity_error, ride.last().strain});
  report.tables.emplace_back("At the end of the motion", brief);

  Plot bars;
  bars.title = "Errors at the end";
  bars.categories = {"mean error (sigma)", "largest error (sigma)", "RMS edge strain"};
  for (const Ride& ride : rides)
    bars.series.push_back(run.series(ride.settings.velocity, {},
                                     {ride.last().errors.end.mean, ride.last().errors.end.max, ride.last().strain}));
  run.write_plot_sheet("translation_errors", "Errors at the end of the translation", {"", {bars}, 1, 640, 320}, report);

  std::vector<Ride> shown{normal, total, curvature};
  if (run.best != "curvature") shown.push_back(ride_of(rides, run.best));
  write_png(run.out / "translation.png", ride_sheet(scene, start, shown, 0.5));
  report.pictures.emplace_back("Fig. 2: the mesh at the start and at the end", "translation.png");
  return report;
}

}  // namespace flowskin::tools
