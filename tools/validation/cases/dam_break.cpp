// A column of water collapses: how fast its front runs along the floor, against two experiments.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/validation/dam_break_data.h"
#include "tools/validation/flow_setup.h"
#include "tools/validation/validation_case.h"

namespace flowskin::tools {
namespace {

using sph::Vec3;

constexpr double width = 0.146, gravity = 9.81, water = 1e-6;  // m, m/s^2, m^2/s; the column is L wide and 2 L high
constexpr int rows = 6;                                        // particles across the sheet, which is periodic

sph::SimulationSetup column(int across) {
  const double spacing = width / across, thickness = rows * spacing, tank = 16 * width;
  sph::SimulationSetup setup = flow_setup(spacing, water, {0, -gravity, 0});
  setup.settings.domain = {{0, 0, 0}, {0, 0, thickness}};
  setup.settings.periodic = {false, false, true};
  setup.bodies.push_back(block_body({0, 0, 0}, {width, 2 * width, thickness}));
  setup.boundaries.push_back(plane_wall({0, 0, 0}, {0, 0, thickness}, {tank, 0, 0}, 0));
  setup.boundaries.push_back(plane_wall({0, 0, 0}, {0, 3 * width, 0}, {0, 0, thickness}, 0));
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
  std::partial_sort(x.begin(), x.begin() + rows, x.end(), std::greater<>());
  double sum = 0;
  for (int k = 0; k < rows; ++k) sum += x[static_cast<std::size_t>(k)];
  return sum / rows + 0.5 * spacing;
}

Front run_column(int across, double end) {
  sph::Solver solver(column(across));
  const double unit = std::sqrt(width / (2 * gravity));
  Front front{{0}, {1}};
  for (double t = 0.05; t < end + 0.05; t += 0.05) {
    solver.advance_to(t * unit);
    front.time.push_back(t);
    front.place.push_back(front_place(solver.state(), width / across) / width);
  }
  return front;
}

// Of the front with its clock `delay` behind that of the experiment. Points before that are the column at rest.
double largest_error(const Front& front, const std::vector<DamBreakPoint>& points, double delay = 0) {
  double worst = 0;
  for (const auto& [t, z] : points) worst = std::max(worst, std::abs(front.at(std::max(0.0, t - delay)) - z) / z);
  return worst;
}

// The column of the computation is free at once; a gate or a diaphragm takes time to open, and when the experiments'
// clocks start is not certain to that time. The delay that fits best, up to 0.4 of the unit of time.
double best_delay(const Front& front, const std::vector<DamBreakPoint>& points) {
  double best = 0;
  for (int k = 1; k <= 40; ++k) {
    const double delay = 0.01 * k;
    if (largest_error(front, points, delay) < largest_error(front, points, best)) best = delay;
  }
  return best;
}

Series series_of(const std::string& name, const std::vector<DamBreakPoint>& points) {
  Series series{name, {}, {}};
  for (const auto& [t, z] : points) series.x.push_back(t), series.y.push_back(z);
  return series;
}

ValidationResult run(double resolution) {
  ValidationResult result;
  result.data.columns = {"series", "time_sqrt_2g_per_l", "front_per_l"};
  Plot plot = line_plot("Front of a collapsing column", "t √(2g/L)", "z / L", {});
  for (const int count : {10, 20, 40}) {
    const int across = static_cast<int>(std::lround(count * resolution));
    const Front front = run_column(across, 9.25);
    const std::string name = fmt::format("{} particles across", across);
    plot.series.push_back({name, front.time, front.place});
    for (std::size_t k = 0; k < front.time.size(); ++k) result.data.add({name, front.time[k], front.place[k]});
    for (const DamBreakSeries& experiment : dam_break_experiments()) {
      result.figures.push_back(at_most(fmt::format("largest error of the front; {}; {}", name, experiment.name),
                                       largest_error(front, experiment.points), 0.05));
      const double delay = best_delay(front, experiment.points);
      result.figures.push_back(at_most(fmt::format("the same, {:.2f} later; {}; {}", delay, name, experiment.name),
                                       largest_error(front, experiment.points, delay), 0.05));
    }
  }
  for (const DamBreakSeries& experiment : dam_break_experiments()) {
    plot.series.push_back(series_of(experiment.name, experiment.points));
    for (const auto& [t, z] : experiment.points) result.data.add({experiment.name, t, z});
  }
  result.plots.plots = {plot};
  return result;
}

}  // namespace

ValidationCase dam_break_case() {
  return {"dam_break", "front of a collapsing column of water against Koshizuka and Oka, Martin and Moyce", false, run};
}

}  // namespace flowskin::tools
