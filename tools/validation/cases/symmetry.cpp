// A scene and its mirror image, or the scene turned by a quarter, must stay each other's image.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "tools/validation/flow_setup.h"
#include "tools/validation/validation_case.h"

namespace flowskin::tools {
namespace symmetry {

using sph::Vec3;

constexpr double kRadius = 0.2;  // m

using Image = std::function<Vec3(const Vec3&)>;

// A drop falls askew on a square plate. The plate is its own image under both maps.
sph::SimulationSetup falling_drop(double spacing, const Vec3& velocity) {
  sph::SimulationSetup setup = flow_setup(spacing, 0.05, {0, -9.81, 0});
  setup.bodies.push_back(ball_body({0, kRadius + 0.5 * spacing, 0}, kRadius, velocity));
  setup.boundaries.push_back(plane_wall({-0.6, 0, -0.6}, {0, 0, 1.2}, {1.2, 0, 0}, 0));
  return setup;
}

// Distance of each image from the particle of the other run that started at the image's place.
double largest_distance(const sph::FluidState& original, const sph::FluidState& other, const Image& image) {
  const auto key = [](const Vec3& p) {
    return std::array<long, 3>{std::lround(1e6 * p.x()), std::lround(1e6 * p.y()), std::lround(1e6 * p.z())};
  };
  std::vector<std::pair<std::array<long, 3>, std::size_t>> places;
  for (std::size_t i = 0; i < other.ids.size(); ++i) places.emplace_back(key(other.rest_positions[i]), i);
  std::sort(places.begin(), places.end());
  double largest = 0;
  for (std::size_t i = 0; i < original.ids.size(); ++i) {
    const auto wanted = key(image(original.rest_positions[i]));
    const auto found = std::lower_bound(places.begin(), places.end(), std::make_pair(wanted, std::size_t{0}));
    if (found == places.end() || found->first != wanted) return std::numeric_limits<double>::quiet_NaN();
    largest = std::max(largest, (other.positions[found->second] - image(original.positions[i])).norm());
  }
  return largest;
}

ValidationResult run(double resolution) {
  const double spacing = kRadius / std::round(8 * resolution);
  const Vec3 velocity(0.3, -1, 0.1);
  const Image mirror = [](const Vec3& p) { return Vec3(-p.x(), p.y(), p.z()); };
  const Image turn = [](const Vec3& p) { return Vec3(p.z(), p.y(), -p.x()); };
  sph::Solver original(falling_drop(spacing, velocity)), mirrored(falling_drop(spacing, mirror(velocity))),
      turned(falling_drop(spacing, turn(velocity)));
  ValidationResult result;
  result.data.columns = {"time_s", "mirrored_spacings", "turned_spacings"};
  Series mirror_series{"mirrored", {}, {}}, turn_series{"turned by 90°", {}, {}};
  for (int n = 1; n <= 20; ++n) {
    const double t = 0.02 * n;
    for (sph::Solver* solver : {&original, &mirrored, &turned}) solver->advance_to(t);
    const double a = largest_distance(original.state(), mirrored.state(), mirror) / spacing;
    const double b = largest_distance(original.state(), turned.state(), turn) / spacing;
    mirror_series.x.push_back(t), mirror_series.y.push_back(a);
    turn_series.x.push_back(t), turn_series.y.push_back(b);
    result.data.add({t, a, b});
  }
  result.figures = {
      at_most("largest distance from the mirror image at 0.4 s (spacings)", mirror_series.y.back(), 0.01),
      at_most("largest distance from the turned image at 0.4 s (spacings)", turn_series.y.back(), 0.01),
  };
  Plot plot =
      line_plot("Symmetry", "time (s)", "largest distance from the image (spacings)", {mirror_series, turn_series});
  plot.log_y = true;
  result.plots.plots = {plot};
  return result;
}

}  // namespace symmetry

ValidationCase symmetry_case() {
  return {"symmetry", "a drop that falls askew on a plate, against its mirror image and turned by a quarter", true,
          symmetry::run};
}

}  // namespace flowskin::tools
