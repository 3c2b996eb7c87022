// Skin friction of boundary layers that are thinner than a particle.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sph/forces/pair_forces.h"
#include "sph/neighbors/neighbor_lists.h"

namespace flowskin::sph {

/// Stress over density (m^2/s^2) on fluid that has been running over a wall at `speed` (m/s), where that place of the
/// wall was wetted `age` seconds ago. Seen from a front that advances over a dry wall, the wall moves under fluid at
/// rest: the layer is that of Sakiadis [1961], 0.4437 rho u^2 / sqrt(u x / nu) at the distance x = u age from the
/// front; above u x / nu = 5e5 the turbulent one of a smooth plate, 0.0296 rho u^2 (u x / nu)^(-1/5) [Schlichting].
double boundary_layer_stress(double speed, double age, double viscosity);

/// What a step of the drag works on.
struct WallDragData {
  std::span<const FluidPack> fluid;
  const PointClusters* clusters;
  std::span<const WallPack> walls;
  const NeighborLists* wall_lists;
  std::span<const float> wall_distances;  ///< As found by compute_forces() (m)
  std::span<const float> viscosities;     ///< Of each particle (m^2/s); empty: the viscosity of the settings
  double time, time_step;                 ///< s
  std::span<ParticleRates> rates;         ///< in and out
};

/// The solver's own friction on walls is nu u / (spacing / 2): right where it resolves the boundary layer. A thinner
/// one resists more; the difference is added to the particles next to the wall. Each place of a wall remembers since
/// when it has been wet. Does nothing, and keeps nothing, where the setting wall_drag is 0.
class WallDrag {
 public:
  WallDrag() = default;
  WallDrag(const SolverSettings& settings, const PairCoefficients& coefficients, const WallKernel& wall);

  bool active() const { return share_ > 0; }
  /// Notes which places are wet, then adds the drag to the rates. The same bytes at any number of threads.
  void add(const WallDragData& data);
  /// For each boundary particle the time (s) since when it has been wet, negative where it is dry: saved state.
  std::vector<double>& wet_since() { return wet_since_; }
  std::size_t memory_bytes() const {
    return wet_since_.capacity() * sizeof(double) + weights_.capacity() * sizeof(std::uint32_t);
  }

 private:
  /// Calls f(cluster, i) for the particles in reach of a wall, on all threads.
  template <typename Function>
  void for_each_at_walls(const WallDragData& data, Function f) const;
  /// Calls f(b, weight, difference) for the boundary particles in reach of particle i.
  template <typename Function>
  void for_each_near(const WallDragData& data, std::size_t cluster, std::size_t i, Function f) const;
  /// What the particles near a boundary particle weigh, and since when it has been wet.
  void note_wet(const WallDragData& data);
  /// What a particle touches: its share of the wall's area (m^2), means over it of the wall's stick and age (s), and
  /// its velocity along the wall, relative to it.
  struct Contact {
    double area = 0, stick = 0, age = 0;
    Eigen::Vector3f slip = Eigen::Vector3f::Zero();
  };
  Contact contact(const WallDragData& data, std::size_t cluster, std::size_t i) const;
  Eigen::Vector3f acceleration(const WallDragData& data, std::size_t cluster, std::size_t i) const;

  double share_ = 0, spacing_ = 0, viscosity_ = 0;
  double area_factor_ = 0;                   // area of a boundary particle over the volume in its pack (m^2)
  float reach2_ = 0;                         // of the walls' kernel (m^2)
  Eigen::Vector3f period_, inverse_period_;  // m, 1/m; 0 along axes that are not periodic
  std::vector<double> wet_since_;
  std::vector<std::uint32_t> weights_;  // of the particles near each boundary particle, in units of 1 / weight_unit
};

}  // namespace flowskin::sph
