// Films down an incline of fluids that are not plain: shear-thinning, with a yield stress, two of different viscosity.
#include <algorithm>
#include <cmath>
#include <functional>

#include "tools/validation/flow_setup.h"
#include "tools/validation/validation_case.h"

namespace flowskin::tools {
namespace rheology {

using sph::Vec3;

constexpr double kDepth = 0.2;  // m
constexpr double kDrive = 5;    // m/s^2 along the incline
constexpr double kEnd = 0.4;    // s; the flow is steady after a tenth of a second

struct Film {
  std::string name;
  std::vector<sph::Fluid> fluids;       // two: the lower and the upper half
  std::function<double(double)> speed;  // in the steady state, at a height (m/s)
  sph::ViscositySolver solver = sph::ViscositySolver::implicit;
};

sph::Fluid fluid(const std::string& name, double viscosity) {
  sph::Fluid fluid;
  fluid.name = name;
  fluid.viscosity = viscosity;
  return fluid;
}

// The stress is rho drive (depth - y); where it is above the yield stress, tau = tau_y + K (du/dy)^n, else the film
// moves as a plug.
Film herschel_bulkley(const std::string& name, double consistency, double flow_index, double yield_stress) {
  Film film{name, {fluid("fluid", 0)}, {}};
  sph::Rheology& law = film.fluids[0].rheology;
  law.consistency = consistency;
  law.flow_index = flow_index;
  law.yield_stress = yield_stress;
  law.regularization = 1000;
  law.max_viscosity = 100;
  const double plug = kDepth - yield_stress / (1000 * kDrive), n = flow_index, power = (n + 1) / n;
  film.speed = [=](double y) {
    const double below = std::pow(plug, power) - std::pow(std::max(0.0, plug - y), power);
    return n / (n + 1) * std::pow(1000 * kDrive / consistency, 1 / n) * below;
  };
  return film;
}

Film two_layers(const std::string& name, double lower, double upper, sph::ViscositySolver solver) {
  Film film{name, {fluid("lower", lower), fluid("upper", upper)}, {}, solver};
  film.speed = [=](double y) {
    const auto moment = [](double height) { return kDrive * (kDepth * height - 0.5 * height * height); };
    const double middle = kDepth / 2;
    return moment(std::min(y, middle)) / lower + (y > middle ? (moment(y) - moment(middle)) / upper : 0);
  };
  return film;
}

// The film in a box that is periodic along the flow and across it. A weak pull towards the plane keeps it together.
sph::SimulationSetup film_setup(const Film& film, int layers) {
  const double spacing = kDepth / layers, width = 6 * spacing;
  sph::SimulationSetup setup = flow_setup(spacing, 1, {kDrive, -0.3, 0});
  setup.settings.viscosity_solver = film.solver;
  setup.settings.max_speed = 0.4;
  add_endless_floor(width, setup);
  setup.fluids = film.fluids;
  const auto parts = static_cast<double>(film.fluids.size());
  for (std::size_t k = 0; k < film.fluids.size(); ++k) {
    const double low = kDepth * static_cast<double>(k) / parts, high = kDepth * static_cast<double>(k + 1) / parts;
    setup.bodies.push_back(block_body({0, low, 0}, {width, high, width}));
    setup.bodies.back().fluid = film.fluids[k].name;
  }
  return setup;
}

ValidationResult run(double resolution) {
  const int layers = 2 * static_cast<int>(std::lround(8 * resolution));
  const auto implicit = sph::ViscositySolver::implicit, steps = sph::ViscositySolver::explicit_steps;
  const std::vector<Film> films{
      herschel_bulkley("power law, n = 0.5", 800, 0.5, 0), herschel_bulkley("Bingham", 1000, 1, 400),
      herschel_bulkley("Herschel-Bulkley, n = 0.7", 900, 0.7, 250),
      two_layers("two fluids, implicit", 0.5, 2, implicit), two_layers("two fluids, explicit", 0.5, 2, steps)};
  ValidationResult result;
  result.data.columns = {"film", "height_m", "speed_m_per_s", "theory_m_per_s"};
  for (const Film& film : films) {
    sph::Solver solver(film_setup(film, layers));
    solver.advance_to(kEnd);
    const sph::FluidState state = solver.state();
    const LayerMeans means = layer_means(
        state, 0, kDepth / layers, [&](std::size_t i) { return state.positions[i].y(); },
        [&](std::size_t i) { return state.velocities[i].x(); });
    Series computed{"computed", means.means, means.centers}, theory{"theory", {}, {}};
    std::vector<double> wanted;
    for (std::size_t k = 0; k < means.centers.size(); ++k) {
      wanted.push_back(film.speed(means.centers[k]));
      std::string name = film.name;
      std::replace(name.begin(), name.end(), ',', ';');
      result.data.add({name, means.centers[k], means.means[k], wanted.back()});
    }
    for (int k = 0; k <= 60; ++k) {
      theory.x.push_back(film.speed(kDepth * k / 60));
      theory.y.push_back(kDepth * k / 60);
    }
    result.figures.push_back(
        at_most("error of the profile (relative L2): " + film.name, relative_l2(means.means, wanted), 0.03));
    result.plots.plots.push_back(line_plot(film.name, "speed (m/s)", "height (m)", {theory, computed}));
  }
  return result;
}

}  // namespace rheology

ValidationCase rheology_case() {
  return {"rheology", "films of shear-thinning, yielding and layered fluids against their steady profiles", true,
          rheology::run};
}

}  // namespace flowskin::tools
