// [FMM13, Figs. 4, 8 and 9]: one particle circles without fairing, and a body of two, whose turning shows.
#include <fmt/format.h>

#include <algorithm>

#include "tools/experiments/experiment.h"
#include "tools/experiments/mesh_pictures.h"
#include "tools/experiments/ride_table.h"
#include "tools/render/video.h"

namespace flowskin::tools {
namespace {

using tracking::Integrator;

// A body and its rides by Euler's method and RK4.
struct Body {
  scenes::Scene scene;
  tracking::SurfaceMesh start;
  std::vector<Ride> rides;

  const Ride& ride(const std::string& method, Integrator integrator) const {
    for (const Ride& ride : rides)
      if (ride.settings.velocity == method && ride.settings.integrator == integrator) return ride;
    throw std::logic_error("no ride with " + method);
  }
};

Body measure(const PaperRun& run, const std::string& name) {
  Body body;
  body.scene = run.scene(name);
  body.start = start_mesh(body.scene);
  RideSettings settings = ride_settings(body.scene);
  if (run.quick) settings.steps_per_period = 12, settings.periods = 3;
  std::vector<RideSettings> all;
  for (const Integrator integrator : {Integrator::euler, Integrator::rk4}) {
    for (const std::string& method : run.methods) {
      settings.velocity = method;
      settings.integrator = integrator;
      all.push_back(settings);
    }
  }
  body.rides = take_rides(body.scene, body.start, all);
  return body;
}

// How the return error of a ride grew from its first revolution to its last.
std::string growth(const Ride& ride) {
  return fmt::format("{} {} to {}", ride.settings.velocity, short_number(ride.checkpoints.front().errors.back.mean),
                     short_number(ride.last().errors.back.mean));
}

bool grows(const Ride& ride) {
  const double first = ride.checkpoints.front().errors.back.mean, last = ride.last().errors.back.mean;
  return last > 2 * first && last > 1e-4;
}

// [FMM13, Fig. 9] as the paper measures it.
Claim total_drifts(const Body& body, const std::string& what, Integrator integrator, const std::string& reason) {
  const Ride &total = body.ride("total", integrator), &curvature = body.ride("curvature", integrator);
  return {"Figs. 4, 8, 9",
          fmt::format("{} ({}): the error of the total velocity grows with the revolutions, curvature invariance keeps "
                      "the mesh (return error).",
                      what, integrator_name(integrator)),
          fmt::format("from revolution 1 to {}, sigma: {}; {}", total.last().period, growth(total), growth(curvature)),
          verdict_of({grows(total), curvature.last().errors.back.mean < 0.5 * total.last().errors.back.mean}), reason};
}

Claim follows_the_turning(const Body& body) {
  const Ride &total = body.ride("total", Integrator::rk4), &curvature = body.ride("curvature", Integrator::rk4);
  return {"Figs. 4, 8, 9",
          "Two particles, against the true rotation: curvature invariance follows it better than the total velocity "
          "(path error, velocity error).",
          fmt::format("path error: total {} sigma, curvature {}; relative velocity error: total {}, curvature {}",
                      short_number(total.last().errors.path), short_number(curvature.last().errors.path),
                      short_number(total.last().errors.velocity_error),
                      short_number(curvature.last().errors.velocity_error)),
          verdict_of({curvature.last().errors.path < total.last().errors.path,
                      curvature.last().errors.velocity_error < total.last().errors.velocity_error}),
          "On the line through both particles the body looks the same from all sides, and its caps are covered by one "
          "particle only: there the field says nothing about the turning, and vertices that are wrong there spread "
          "without fairing. The velocity error is that of the vertices where they are."};
}

void add_table(const std::string& caption, const Body& body, bool without_spin, ExperimentReport& report) {
  ResultTable table;
  table.columns = {"method",          "integrator", "return error (sigma), first revolution",
                   "last revolution", "path error", "velocity error",
                   "edge strain"};
  for (const Ride& ride : body.rides) {
    const auto errors = [&](const RideCheckpoint& at) { return without_spin ? at.unspinning : at.errors; };
    table.add({ride.settings.velocity, integrator_name(ride.settings.integrator),
               errors(ride.checkpoints.front()).back.mean, errors(ride.last()).back.mean, errors(ride.last()).path,
               errors(ride.last()).velocity_error, ride.last().strain});
  }
  report.tables.emplace_back(caption, table);
}

// Error by revolutions; `value` takes a checkpoint.
template <class Value>
Plot error_plot(const PaperRun& run, const Body& body, Integrator integrator, const std::string& title,
                const std::string& measure, Value value) {
  Plot plot;
  plot.title = title;
  plot.x_label = "revolutions";
  plot.y_label = measure + " (sigma)";
  plot.log_y = true;
  for (const std::string& method : run.methods) {
    std::vector<double> x, y;
    for (const RideCheckpoint& checkpoint : body.ride(method, integrator).checkpoints) {
      x.push_back(checkpoint.period);
      y.push_back(value(checkpoint));
    }
    plot.series.push_back(run.series(method, x, y));
  }
  return plot;
}

// [FMM13, Fig. 9], and what it does not see.
void plot_errors(const PaperRun& run, const Body& ball, const Body& pair, ExperimentReport& report) {
  const auto back = [](const RideCheckpoint& at) { return at.errors.back.mean; };
  const auto path = [](const RideCheckpoint& at) { return at.errors.path; };
  PlotSheet sheet;
  sheet.title = "Error by revolutions, no fairing";
  sheet.plots = {error_plot(run, ball, Integrator::euler, "One particle, Euler", "return error", back),
                 error_plot(run, ball, Integrator::rk4, "One particle, RK4", "return error", back),
                 error_plot(run, pair, Integrator::rk4, "Two particles, RK4", "return error", back),
                 error_plot(run, pair, Integrator::rk4, "Two particles, RK4", "path error", path)};
  run.write_plot_sheet("circling", "Fig. 9: error by the number of revolutions", sheet, report);
}

// One row per method, one column per number of revolutions, as in Fig. 4.
void draw(const PaperRun& run, const Body& body, Integrator integrator, const std::string& caption,
          ExperimentReport& report) {
  std::vector<std::string> methods{"total", "curvature"};
  if (run.best != "curvature") methods.push_back(run.best);
  const int last = body.rides.front().last().period;
  const MeshPainter painter(body.scene, body.start);
  std::vector<std::vector<Image>> rows;
  std::vector<std::string> columns{"start"};
  for (const int share : {1, 2, 3}) columns.push_back(fmt::format("{} revolutions", last * share / 3));
  for (const std::string& method : methods) {
    std::vector<Image>& row = rows.emplace_back();
    tracking::SurfaceMesh mesh = body.start;
    row.push_back(painter.textured(mesh));
    for (const int share : {1, 2, 3}) {
      mesh.positions = body.ride(method, integrator).checkpoints[std::size_t(last * share / 3 - 1)].positions;
      row.push_back(painter.textured(mesh));
    }
  }
  const std::string file = body.scene.name + ".png";
  write_png(run.out / file, contact_sheet(rows, methods, columns, std::min(380, body.scene.render.width)));
  report.pictures.emplace_back(caption, file);
}

}  // namespace

ExperimentReport circling_experiment(const PaperRun& run) {
  const Body ball = measure(run, "circling_ball"), pair = measure(run, "circling_pair");
  ExperimentReport report;
  report.title = "A circling particle without fairing (Figs. 4, 8 and 9)";
  const RideSettings& settings = ball.rides.front().settings;
  report.setup = fmt::format(
      "`circling_ball.json` ({} vertices) and `circling_pair.json` ({}): {} revolutions of {} steps, Euler's method "
      "and "
      "RK4, no fairing.\n\n"
      "The field of a single ball is the same whether it spins or not, so no method that sees only the field can tell "
      "the two apart, and neither could the paper. Two motions can be called true: the body turns with its circle "
      "(`motion`), or it moves in parallel (`without spin`). Both are in the tables. The second body, of two "
      "particles, "
      "shows its turning, and there only the rotation is true.",
      ball.start.positions.size(), pair.start.positions.size(), settings.periods, settings.steps_per_period);
  ResultTable table = ride_table();
  for (const Ride& ride : ball.rides) {
    add_ride(table, ball.scene, ride);
    add_ride(table, ball.scene, ride, true);
  }
  for (const Ride& ride : pair.rides) add_ride(table, pair.scene, ride);
  run.write_csv("circling", table, report);
  add_table("One particle, against the motion without spin", ball, true, report);
  add_table("One particle, against the rotation: its spin is invisible", ball, false, report);
  add_table("Two particles, against the rotation", pair, false, report);

  const std::string blind =
      "On a ball K and H are constant, so the rows of curvature invariance say nothing and the total velocity decides "
      "in "
      "both methods: here they are the same. A difference between them on this scene comes from how they are solved.";
  const std::string kind =
      "The total velocity comes back after each revolution because it hardly turns the mesh; see the path error.";
  report.claims = {total_drifts(ball, "One particle", Integrator::euler, blind),
                   total_drifts(ball, "One particle", Integrator::rk4, blind),
                   total_drifts(pair, "Two particles", Integrator::euler, kind),
                   total_drifts(pair, "Two particles", Integrator::rk4, kind), follows_the_turning(pair)};
  plot_errors(run, ball, pair, report);
  draw(run, ball, Integrator::euler, "Figs. 4 and 8: one particle, Euler's method", report);
  draw(run, pair, Integrator::rk4, "The same with a body of two particles, RK4", report);
  return report;
}

}  // namespace flowskin::tools
