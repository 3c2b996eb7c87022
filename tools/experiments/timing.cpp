// Milliseconds per step, as the paper gives them for the scene of Fig. 6.
#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <memory>

#include "tools/experiments/experiment.h"
#include "tools/experiments/ride.h"
#include "tools/report/stage_clock.h"
#include "tracking/advection/projection.h"
#include "tracking/fairing/fairing.h"
#include "tracking/field/metaballs/metaball_field.h"
#include "tracking/mesh/adjacency.h"
#include "tracking/velocity/velocity_method.h"

namespace flowskin::tools {
namespace {

// [FMM13, 4], 3.2 GHz Core i7, mesh size not given.
constexpr double kPaperTotal = 32, kPaperCurvature = 73, kPaperFairing = 30;  // ms per step
constexpr int kIterations = 10;

// Sets the number of threads until its end.
class OneThread {
 public:
  OneThread() { omp_set_num_threads(1); }
  ~OneThread() { omp_set_num_threads(before_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  int before_ = omp_get_max_threads();
};

// Milliseconds of the parts of a step: medians.
struct StepTime {
  int vertices = 0;
  double velocity = 0, projection = 0, fairing = 0;
  double with_fairing() const { return velocity + projection + fairing; }
  double without_fairing() const { return velocity + projection; }
};

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Euler steps of 1/60 revolution.
StepTime time_steps(const scenes::Scene& scene, const tracking::SurfaceMesh& start, const std::string& name,
                    int most_steps) {
  constexpr double kEnough = 1.0;  // s
  const MaterialMotion motion(scene);
  const auto method = tracking::make_velocity_method(name);
  const auto topology = tracking::build_adjacency(int(start.positions.size()), start.triangles);
  const auto rest_lengths = tracking::edge_lengths(topology, start.positions);
  const auto projection = tracking::default_projection(motion.field_settings().scale());
  std::vector<Vec3> positions = start.positions, velocities;
  std::vector<double> velocity, projecting, fairing;
  const double step = motion.period() / 60, started = wall_seconds();
  for (int i = 0; i < most_steps && (i < 3 || wall_seconds() < started + kEnough); ++i) {
    const tracking::MetaballField now = motion.field(i * step), next = motion.field((i + 1) * step);
    const double begin = wall_seconds();
    method->evaluate(now, topology, positions, velocities);
    const double moved = wall_seconds();
    for (std::size_t v = 0; v < positions.size(); ++v) positions[v] += step * velocities[v];
    tracking::project_to_surface(next, projection, positions);
    const double projected = wall_seconds();
    tracking::fair(next, topology, rest_lengths, {kIterations, scene.tracking.fairing_stiffness}, {}, positions);
    const double faired = wall_seconds();
    tracking::project_to_surface(next, projection, positions);
    velocity.push_back(1e3 * (moved - begin));
    projecting.push_back(1e3 * (projected - moved));
    fairing.push_back(1e3 * (faired - projected));
  }
  return {int(positions.size()), median_of(velocity), median_of(projecting), median_of(fairing)};
}

Plot bars(const PaperRun& run, const std::vector<StepTime>& times) {
  Plot plot;
  plot.title = fmt::format("{} vertices", times.front().vertices);
  plot.y_label = "ms";
  plot.categories = run.methods;
  plot.series = {{"velocity", {}, {}}, {"projection", {}, {}}, {"10 fairing iterations", {}, {}}};
  for (const StepTime& time : times) {
    plot.series[0].y.push_back(time.velocity);
    plot.series[1].y.push_back(time.projection);
    plot.series[2].y.push_back(time.fairing);
  }
  return plot;
}

Claim curvature_costs_more(const StepTime& total, const StepTime& curvature) {
  return {
      "Sec. 4",
      fmt::format("A step with 10 fairing iterations takes {} ms with the total velocity and {} ms with curvature "
                  "invariance: about 2 and 43 ms for the velocities, {} ms for the fairing.",
                  kPaperTotal, kPaperCurvature, kPaperFairing),
      fmt::format("{} vertices, one thread: {:.2f} and {:.2f} ms; velocities {:.2f} and {:.2f} ms, fairing {:.2f} ms",
                  total.vertices, total.with_fairing(), curvature.with_fairing(), total.velocity, curvature.velocity,
                  curvature.fairing),
      verdict_of(
          {curvature.with_fairing() > total.with_fairing(), curvature.with_fairing() > 2 * total.with_fairing()}),
      fmt::format("Judged by the ratio of the two, as the paper's mesh size is not given and its processor was "
                  "another one: curvature costs {:.2f} times the step of total, in the paper {:.2f} times. The "
                  "paper's {:g} ms of fairing are those of about {:.0f} vertices here; their velocities take {:.1f} "
                  "and {:.1f} ms.",
                  curvature.with_fairing() / total.with_fairing(), kPaperCurvature / kPaperTotal, kPaperFairing,
                  total.vertices * kPaperFairing / total.fairing, total.velocity * kPaperFairing / total.fairing,
                  curvature.velocity * kPaperFairing / total.fairing)};
}

Claim solving_dominates(const StepTime& total, const StepTime& curvature) {
  return {"Sec. 4",
          "Most of the processing time of curvature invariance is the minimisation (43 of 73 ms, 20 times the total "
          "velocity).",
          fmt::format("velocity is {:.0f} % of a step with curvature; curvature / total velocity: {:.2f}",
                      100 * curvature.velocity / curvature.with_fairing(), curvature.velocity / total.velocity),
          verdict_of({curvature.velocity > 0.5 * curvature.with_fairing()}),
          "The system is linear, so it is solved directly here; the paper minimises with Powell's method."};
}

}  // namespace

ExperimentReport timing_experiment(const PaperRun& run) {
  const OneThread one_thread;
  ExperimentReport report;
  report.title = "Time per step (Sec. 4)";
  report.setup =
      "`ring_weak.json` with meshes of several sizes: Euler steps of 1/60 revolution on one thread, medians. Without "
      "fairing: velocity and projection; with: 10 iterations more. Times depend on the machine and what else it does.";
  ResultTable table;
  table.columns = {"vertices",
                   "method",
                   "velocity (ms)",
                   "projection (ms)",
                   "10 fairing iterations (ms)",
                   "without fairing (ms)",
                   "with fairing (ms)"};
  const std::vector<double> edges = run.quick ? std::vector<double>{0.3} : std::vector<double>{0.3, 0.15, 0.075};
  StepTime total, curvature;
  PlotSheet sheet;
  sheet.title = "Milliseconds per step, one thread";
  sheet.columns = int(edges.size());
  for (const double edge : edges) {
    scenes::Scene scene = run.scene("ring_weak");
    scene.tracking.edge_length = edge;
    const tracking::SurfaceMesh start = start_mesh(scene);
    std::vector<StepTime> times;
    for (const std::string& method : run.methods) {
      const StepTime time = time_steps(scene, start, method, run.quick ? 3 : 60);
      table.add({time.vertices, method, time.velocity, time.projection, time.fairing, time.without_fairing(),
                 time.with_fairing()});
      times.push_back(time);
      if (method == "total") total = time;
      if (method == "curvature") curvature = time;
    }
    sheet.plots.push_back(bars(run, times));
  }
  run.write_csv("timing", table, report);
  run.write_plot_sheet("timing", "Milliseconds per step by mesh size", sheet, report);
  report.tables.emplace_back("Milliseconds per step", table);
  report.claims = {curvature_costs_more(total, curvature), solving_dominates(total, curvature)};
  return report;
}

}  // namespace flowskin::tools
