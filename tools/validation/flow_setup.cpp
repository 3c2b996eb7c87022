#include "tools/validation/flow_setup.h"

#include <cmath>
#include <map>
#include <numeric>

#include "sph/forces/equation_of_state.h"

namespace flowskin::tools {

using sph::Vec3;

sph::SimulationSetup flow_setup(double spacing, double viscosity, const Vec3& gravity) {
  sph::SimulationSetup setup;
  setup.settings.spacing = spacing;
  setup.settings.viscosity = viscosity;
  setup.settings.gravity = gravity;
  return setup;
}

sph::FluidBody block_body(const Vec3& min, const Vec3& max, const Vec3& velocity) {
  sph::FluidBody body;
  body.block = {min, max};
  body.velocity = velocity;
  return body;
}

sph::FluidBody ball_body(const Vec3& center, double radius, const Vec3& velocity) {
  sph::FluidBody body;
  body.shape = sph::FluidBody::Shape::ball;
  body.center = center;
  body.radius = radius;
  body.velocity = velocity;
  return body;
}

sph::Boundary plane_wall(const Vec3& corner, const Vec3& edge_a, const Vec3& edge_b, double slip) {
  sph::Boundary wall;
  wall.slip = slip;
  wall.mesh.positions = {corner, corner + edge_a, corner + edge_a + edge_b, corner + edge_b};
  wall.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return wall;
}

void add_endless_floor(double length, sph::SimulationSetup& setup) {
  setup.settings.domain = {{0, 0, 0}, {length, 0, length}};
  setup.settings.periodic = {true, false, true};
  setup.boundaries.push_back(plane_wall({0, 0, 0}, {0, 0, length}, {length, 0, 0}, 0));
}

LayerMeans layer_means(const sph::FluidState& state, double low, double thickness,
                       const std::function<double(std::size_t)>& height,
                       const std::function<double(std::size_t)>& value) {
  struct Layer {
    double height = 0, value = 0, count = 0;
  };
  std::map<long, Layer> layers;
  for (std::size_t i = 0; i < state.ids.size(); ++i) {
    Layer& layer = layers[std::lround(std::floor((height(i) - low) / thickness))];
    layer.height += height(i);
    layer.value += value(i);
    layer.count += 1;
  }
  LayerMeans means;
  for (const auto& [index, layer] : layers) {
    means.centers.push_back(layer.height / layer.count);
    means.means.push_back(layer.value / layer.count);
  }
  return means;
}

std::vector<double> pressures(const sph::FluidState& state, const sph::SolverSettings& settings) {
  const double bulk = settings.rest_density * settings.speed_of_sound * settings.speed_of_sound;
  std::vector<double> result;
  result.reserve(state.densities.size());
  for (const double density : state.densities)
    result.push_back(bulk * sph::clamped_pressure(density / settings.rest_density - 1));
  return result;
}

double relative_l2(const std::vector<double>& computed, const std::vector<double>& reference) {
  double error = 0, norm = 0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    error += (computed[i] - reference[i]) * (computed[i] - reference[i]);
    norm += reference[i] * reference[i];
  }
  return std::sqrt(error / norm);
}

double fitted_slope(const std::vector<double>& x, const std::vector<double>& y) {
  const double count = static_cast<double>(x.size());
  const double mean_x = std::accumulate(x.begin(), x.end(), 0.0) / count;
  const double mean_y = std::accumulate(y.begin(), y.end(), 0.0) / count;
  double xy = 0, xx = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xy += (x[i] - mean_x) * (y[i] - mean_y);
    xx += (x[i] - mean_x) * (x[i] - mean_x);
  }
  return xy / xx;
}

}  // namespace flowskin::tools
