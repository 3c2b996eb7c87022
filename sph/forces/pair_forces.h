// The pair loops: densities, accelerations and rates of compression from the neighbour lists.
#pragma once

#include <span>

#include "sph/neighbors/neighbor_lists.h"
#include "sph/pairs/particle_pack.h"
#include "sph/setup/settings.h"
#include "sph/walls/wall_kernel.h"

namespace flowskin::sph {

/// A shift (m) out of reach of everything, along an axis that is not periodic: a particle that a wall hides is taken
/// there. Zero where all axes are periodic.
inline Eigen::Vector3f away_from_all(const SolverSettings& s) {
  Eigen::Vector3f away = Eigen::Vector3f::Zero();
  for (int a = 0; a < 3; ++a) {
    if (s.periodic[a]) continue;
    away[a] = static_cast<float>(1e9 * s.support_radius * s.spacing);
    break;
  }
  return away;
}

/// Constants of the pair loops, worked out once from the settings. V is the volume of a particle divided by the kernel
/// sum of the lattice, G the kernel's gradient scale (kernels.h); an index b means the kernel of the walls.
struct PairCoefficients {
  PairCoefficients() = default;
  /// @param variable_viscosity the viscous coefficients are those of 1 m^2/s, to be multiplied by that of each pair
  PairCoefficients(const SolverSettings& settings, const WallKernel& wall, bool variable_viscosity = false);

  /// Pressure entry of a FluidPack: V G p rho_0 / rho^2 with p clamped at zero.
  float pack_pressure(float compression) const;

  float inverse_support = 0;           ///< 1 / R
  float kernel_scale = 0;              ///< V / R^3
  float kernel_gradient = 0;           ///< V G
  float pressure_scale = 0;            ///< V G c^2
  float background = 0;                ///< Background pressure / (rho_0 c^2)
  float least_pressure = 0;            ///< In the same unit; without limit where particles are shifted
  float least_compression = 0;         ///< Of the summed density: 0 where there are free surfaces.
  float diffusion = 0;                 ///< 2 delta h c V G
  float viscosity = 0;                 ///< nu times lattice_viscosity_scale(), 1/(m^2 s)
  float compression_gradient[3] = {};  ///< Slope of the compression of fluid at rest: g / c^2 (1/m)
  float xsph = 0;                      ///< xsph V / R^3
  float shift_scale = 0;               ///< particle_shifting R V G (1/m)
  float wall_inverse_support = 0;      ///< 1 / R_b
  float wall_gradient = 0;             ///< G_b R_b^3
  float wall_pressure = 0;             ///< G_b R_b^3 / (V G)
  float wall_viscosity = 0;            ///< as viscosity, with G_b R_b^3 and the walls' friction factor
  float wall_softening = 0;
  float wall_barrier_from = 0;                     ///< Compression by walls, twice that of fluid at rest on a plane
  float period[3] = {}, inverse_period[3] = {};    ///< m, 1/m; 0 along axes that are not periodic
  Eigen::Vector3f away = Eigen::Vector3f::Zero();  ///< away_from_all() (m)
};

/// Result for one particle.
struct alignas(16) ParticleRates {
  using plain_numbers = float;
  float ax, ay, az;        ///< Acceleration by pressure and viscosity, without gravity (m/s^2).
  float compression_rate;  ///< 1/s; continuity density only
};

/// What the pair loops work on.
struct PairData {
  std::span<FluidPack> fluid;
  const PointClusters* clusters;
  const NeighborLists* fluid_lists;
  std::span<const WallPack> walls;
  const NeighborLists* wall_lists;
  float time_step;                    ///< s; makes the friction on walls stable at any viscosity
  std::span<ParticleRates> rates;     ///< out
  std::span<float> wall_distances;    ///< out: distance to the nearest boundary particle in the lists, else 1e9 (m)
  std::span<Eigen::Vector3f> shifts;  ///< out: XSPH or shifting velocity (m/s); empty where both are off
  bool viscous = true;                ///< false: no viscosity and friction; ImplicitViscosity adds them
  std::span<const float> viscosities = {};  ///< Of each particle (m^2/s); empty: all the same
  float fastest = 0;                        ///< Speed of the fastest particle (m/s), which scales the shifting
};

inline bool is_periodic(const SolverSettings& settings) {
  return settings.periodic[0] || settings.periodic[1] || settings.periodic[2];
}

/// Sets compression and pressure of all packs by summation over the neighbours.
void sum_densities(const PairCoefficients& coefficients, const SolverSettings& settings, const PairData& data);

/// Sets the rates. In each pair of fluid particles both get exactly opposite forces (the arithmetic is the same up to
/// sign), so momentum is kept up to the rounding of the sums.
void compute_forces(const PairCoefficients& coefficients, const SolverSettings& settings, const PairData& data);

}  // namespace flowskin::sph
