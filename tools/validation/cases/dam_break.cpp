// A column of water collapses: how fast its front runs along the dry floor, against two papers' experiments.
//
// Front and clock. The column of the computation is free at once. Gates and diaphragms take time to open, and no clock
// is certain to that time: the fronts of the experiments are 0.15 to 0.25 units of time late from the first point on.
// So each series is given one delay, from its first two points, where the front has gone half a width; with it all
// later points are predicted. The error with the clock as published is told without a verdict.
//
// Friction. The tongue is thin and the floor dry, so that boundary layers rule its tip [Whitham 1955];
// simulation.wall_drag stands for them. Columns are computed at the size they had: friction makes small ones slower.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/validation/dam_break_data.h"
#include "tools/validation/flow_setup.h"
#include "tools/validation/validation_case.h"

namespace flowskin::tools {
namespace dam_break {

using sph::Vec3;

constexpr double kGravity = 9.81, kWater = 1e-6;  // m/s^2, m^2/s
constexpr int kRows = 6;                          // particles across the sheet, which is periodic

sph::SimulationSetup column(const DamBreakSeries& experiment, int across) {
  const double width = experiment.width, height = experiment.height * width;
  const double spacing = width / across, thickness = kRows * spacing, tank = 20 * width;
  sph::SimulationSetup setup = flow_setup(spacing, kWater, {0, -kGravity, 0});
  setup.settings.wall_drag = 1;
  setup.settings.domain = {{0, 0, 0}, {0, 0, thickness}};
  setup.settings.periodic = {false, false, true};
  setup.bodies.push_back(block_body({0, 0, 0}, {width, height, thickness}));
  setup.boundaries.push_back(plane_wall({0, 0, 0}, {0, 0, thickness}, {tank, 0, 0}, 0));
  setup.boundaries.push_back(plane_wall({0, 0, 0}, {0, 1.5 * height, 0}, {0, 0, thickness}, 0));
  return setup;
}

struct Front {
  std::vector<double> time, place;  // T = t sqrt(2 g / L), Z = z / L

  double at(double t) const {
    const auto next = std::upper_bound(time.begin(), time.end(), t);
    const std::size_t k = std::clamp<std::size_t>(static_cast<std::size_t>(next - time.begin()), 1, time.size() - 1);
    const double share = (t - time[k - 1]) / (time[k] - time[k - 1]);
    return place[k - 1] + share * (place[k] - place[k - 1]);
  }
};

// The place of the foremost row of particles, half a spacing ahead of their mean: drops that fly ahead do not count
// much.
double front_place(const sph::FluidState& state, double spacing) {
  std::vector<double> x;
  for (const Vec3& p : state.positions) x.push_back(p.x());
  std::partial_sort(x.begin(), x.begin() + kRows, x.end(), std::greater<>());
  double sum = 0;
  for (int k = 0; k < kRows; ++k) sum += x[static_cast<std::size_t>(k)];
  return sum / kRows + 0.5 * spacing;
}

Front run_column(const DamBreakSeries& experiment, int across) {
  sph::Solver solver(column(experiment, across));
  const double unit = std::sqrt(experiment.width / (2 * kGravity)), end = experiment.points.back().time;
  Front front{{0}, {1}};
  for (double t = 0.05; t < end + 0.05; t += 0.05) {
    solver.advance_to(t * unit);
    front.time.push_back(t);
    front.place.push_back(front_place(solver.state(), experiment.width / across) / experiment.width);
  }
  return front;
}

// Of the front with its clock `delay` behind that of the experiment. Points before that are the column at rest.
double largest_error(const Front& front, const std::vector<DamBreakPoint>& points, double delay) {
  double worst = 0;
  for (const auto& [t, z] : points) worst = std::max(worst, std::abs(front.at(std::max(0.0, t - delay)) - z) / z);
  return worst;
}

// The delay by which the first two points after the start fit best.
double early_delay(const Front& front, const std::vector<DamBreakPoint>& points) {
  std::vector<DamBreakPoint> early;
  for (const DamBreakPoint& point : points) {
    if (point.time > 0 && early.size() < 2) early.push_back(point);
  }
  double best = -0.2;
  for (int k = -40; k <= 100; ++k) {
    const double delay = 0.005 * k;
    if (largest_error(front, early, delay) < largest_error(front, early, best)) best = delay;
  }
  return best;
}

Series series_of(const std::string& name, const std::vector<DamBreakPoint>& points) {
  Series series{name, {}, {}};
  for (const auto& [t, z] : points) series.x.push_back(t), series.y.push_back(z);
  return series;
}

void compare(const DamBreakSeries& experiment, int across, Plot& plot, ValidationResult& result) {
  const Front front = run_column(experiment, across);
  const std::string particles = fmt::format("{} particles across", across);
  const double delay = early_delay(front, experiment.points);
  Series shifted{particles, {}, {}};
  for (std::size_t k = 0; k < front.time.size(); ++k) {
    shifted.x.push_back(front.time[k] + delay);
    shifted.y.push_back(front.place[k]);
    result.data.add({experiment.name + "; " + particles, front.time[k], front.place[k]});
  }
  plot.series.push_back(shifted);
  const std::string what = experiment.name + "; " + particles;
  result.figures.push_back(at_most(fmt::format("largest error of the front; {}; {:.3f} later", what, delay),
                                   largest_error(front, experiment.points, delay), 0.05));
  result.figures.push_back(for_information(fmt::format("the same; clock as published; {}", what),
                                           largest_error(front, experiment.points, 0)));
}

ValidationResult run(double resolution) {
  ValidationResult result;
  result.data.columns = {"series", "time_sqrt_2g_per_l", "front_per_l"};
  for (const DamBreakSeries& experiment : dam_break_experiments()) {
    Plot plot = line_plot(experiment.name, "t √(2g/L)", "z / L", {});
    for (const int count : {10, 20, 40})
      compare(experiment, static_cast<int>(std::lround(count * resolution)), plot, result);
    plot.series.push_back(series_of("measured", experiment.points));
    for (const auto& [t, z] : experiment.points) result.data.add({experiment.name, t, z});
    result.plots.plots.push_back(plot);
  }
  return result;
}

}  // namespace dam_break

ValidationCase dam_break_case() {
  return {"dam_break", "front of a collapsing column of water against Koshizuka and Oka, Martin and Moyce", false,
          dam_break::run};
}

}  // namespace flowskin::tools
