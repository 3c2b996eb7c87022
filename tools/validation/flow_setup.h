// Set-ups of simple flows and what is read off them, for the validations.
#pragma once

#include <functional>
#include <vector>

#include "sph/solver.h"

namespace flowskin::tools {

/// Settings with the spacing (m), the kinematic viscosity (m^2/s) and the gravity (m/s^2); the rest at its default.
sph::SimulationSetup flow_setup(double spacing, double viscosity, const sph::Vec3& gravity);

/// A block of fluid with one velocity (m/s).
sph::FluidBody block_body(const sph::Vec3& min, const sph::Vec3& max, const sph::Vec3& velocity = sph::Vec3::Zero());

/// A ball of fluid.
sph::FluidBody ball_body(const sph::Vec3& center, double radius, const sph::Vec3& velocity = sph::Vec3::Zero());

/// A parallelogram as a wall: a corner and two edges (m). `slip`: 0 no-slip, 1 free slip.
sph::Boundary plane_wall(const sph::Vec3& corner, const sph::Vec3& edge_a, const sph::Vec3& edge_b, double slip);

/// Makes the setup endless along x and z, with a period of `length` (m), over a no-slip floor at y = 0.
void add_endless_floor(double length, sph::SimulationSetup& setup);

/// A quantity of the particles, averaged over layers of equal thickness.
struct LayerMeans {
  std::vector<double> centers;  ///< Mean height of the particles of the layer (m).
  std::vector<double> means;
};

/// Layers of `thickness` from `low` on; layers without particles are left out.
LayerMeans layer_means(const sph::FluidState& state, double low, double thickness,
                       const std::function<double(std::size_t)>& height,
                       const std::function<double(std::size_t)>& value);

/// Pressure (Pa) of each particle by the solver's equation of state.
std::vector<double> pressures(const sph::FluidState& state, const sph::SolverSettings& settings);

/// sqrt(sum (computed - reference)^2 / sum reference^2)
double relative_l2(const std::vector<double>& computed, const std::vector<double>& reference);

/// Slope of the straight line of least squares through (x, y).
double fitted_slope(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace flowskin::tools
