// Surface tension of a free surface, and the adhesion of fluid to walls.
#pragma once

#include <span>

#include "sph/forces/pair_forces.h"
#include "sph/neighbors/neighbor_lists.h"

namespace flowskin::sph {

/// Surface tension as a stress in the particles near the surface [Lafaurie et al. 1994; Hu and Adams 2006]:
/// T = K gamma |grad c| (I - n n), where c = V sum_j W_ij counts fluid only and n is its direction; a_i = V^2/m sum_j
/// (T_i + T_j) . grad W_ij. W is a Wendland kernel of its own, wider than that of the fluid. K makes the stress of the
/// half space filled with the lattice of the start pull with exactly gamma across a line in the surface.
///
/// Walls attract fluid from their surface with f(r) ~ r (1 - r/D)^2, so strongly that pulling fluid off takes the work
/// of adhesion 2 adhesion gamma an area; the contact angle is then cos theta = 2 adhesion - 1 (Young and Dupre).
struct SurfaceTension {
  SurfaceTension() = default;
  explicit SurfaceTension(const SolverSettings& settings);

  bool active() const { return stress_scale > 0; }
  /// |grad c| of a particle times what counts of it: the disorder inside the fluid has none.
  float counted_gradient(float gradient) const;

  double reach = 0;          ///< Support radius D of the kernel, and of the attraction of walls (m).
  float inverse_reach = 0;   ///< 1 / D (1/m)
  float gradient_scale = 0;  ///< V G, G the kernel's gradient scale (kernels.h)
  float least_gradient = 0;  ///< |grad c| up to which nothing counts (1/m) ...
  float inverse_ramp = 0;    ///< ... and the inverse of the width over which it comes to count.
  float stress_scale = 0;    ///< K gamma V^2 G / m
  float period[3] = {}, inverse_period[3] = {};  ///< m, 1/m; 0 along axes that are not periodic
  bool periodic = false;
  Eigen::Vector3f away = Eigen::Vector3f::Zero();  ///< away_from_all() (m)
  float wall_attraction = 0;                       ///< Acceleration over distance, per adhesion and area (1/(m^2 s^2)).
};

/// Speed of sound (m/s) at which the pressure in a drop as small as a spacing, 2 gamma / spacing, compresses by 1 %.
double capillary_speed_of_sound(const SolverSettings& settings);

/// Longest step (s) for capillary waves as short as the smoothing length: sqrt(rho h^3 / (2 pi gamma)) [Brackbill et
/// al. 1992]; infinite without surface tension.
double capillary_time(const SolverSettings& settings);

/// Unit normal (outward) of a particle, and its stress K gamma |grad c| V^2 G / m; zero inside the fluid.
struct alignas(16) SurfaceStress {
  float nx, ny, nz, stress;
};

/// What the loops work on. Lists reach at least as far as the model.
struct SurfaceTensionData {
  std::span<const FluidPack> fluid;
  const PointClusters* clusters;
  const NeighborLists* fluid_lists;
  std::span<const WallPack> walls;
  std::span<const float> wall_adhesions;  ///< adhesion times area (m^2); empty where no wall attracts
  const NeighborLists* wall_lists;
  std::span<SurfaceStress> stresses;  ///< room for one per particle
  std::span<ParticleRates> rates;     ///< in and out
};

/// Adds the accelerations to the rates. Both particles of a pair of fluid get exactly opposite forces, so momentum is
/// kept up to the rounding of the sums.
void add_surface_tension(const SurfaceTension& model, const SurfaceTensionData& data);

}  // namespace flowskin::sph
