// The viscous part of a time step, taken implicitly: (I - dt nu L) v = v*, by conjugate gradients.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sph/forces/pair_forces.h"
#include "sph/neighbors/neighbor_lists.h"
#include "sph/pairs/lanes.h"
#include "sph/pairs/particle_pack.h"
#include "sph/setup/settings.h"

namespace flowskin::sph {

/// What the viscous step works on.
struct ViscousProblem {
  std::span<FluidPack> fluid;  ///< Positions are read; velocities are overwritten with anything.
  const PointClusters* clusters;
  const NeighborLists* fluid_lists;
  std::span<const WallPack> walls;
  const NeighborLists* wall_lists;
  std::span<const float> viscosities;    ///< Kinematic viscosity of each particle (m^2/s); empty: all the same
  std::span<const ParticleRates> rates;  ///< Accelerations by all else than viscosity and gravity (m/s^2)
  std::span<const std::uint8_t> fixed;   ///< Not 0: the particle keeps its velocity; empty: none does
  double time_step;                      ///< s
  std::span<Vec3> velocities;            ///< in: at the start of the step; out: at its end (m/s)
};

/// Weiler, Koschier, Brand and Bender 2018, "A physically consistent implicit viscosity solver for SPH fluids":
/// backward Euler with the operator L of the explicit force, which is symmetric and negative as all volumes are equal,
/// so that I - dt nu L has no eigenvalue below 1. The matrix is never stored: its product is one more pair loop.
///
/// With v the velocity at the start of the step and dt a what pressure and gravity add, x = v is the first guess (good
/// where viscosity balances the rest); where it is not good, the best x = v + alpha dt a (exact in free fall). The
/// result is x + r, r the last residual: as x + r = v* + dt nu L x, linear and (Monaghan's form) angular momentum are
/// kept to rounding, however exactly the system was solved; since no eigenvalue is below 1, the error of x + r is below
/// |r|.
class ImplicitViscosity {
 public:
  struct Result {
    int iterations = 0;
    double residual = 0;     ///< Root mean square of the residual (m/s): a bound for the error of the velocities.
    double tolerance = 0;    ///< The residual asked for (m/s).
    bool converged = false;  ///< False: the velocities are as they were.
  };

  /// The result does not depend on the number of threads.
  Result solve(const PairCoefficients& coefficients, const SolverSettings& settings, const ViscousProblem& problem);

  std::size_t memory_bytes() const;

 private:
  /// A vector of three components per particle, one cluster of particles per entry.
  struct Lanes3 {
    Float8 x{}, y{}, z{};
  };
  /// A symmetric 3 x 3 matrix per particle.
  struct Blocks {
    Float8 xx{}, xy{}, xz{}, yy{}, yz{}, zz{};
  };
  struct Sums {
    double rz = 0, rr = 0;  // r.z and r.r
    double direction = 0;   // p.A p; at first kick.r
    double kick = 0;        // kick.kick, with kick = dt a
    double scale = 0;       // square of the change of the velocities that the tolerance refers to

    Sums& operator+=(const Sums& o) {
      rz += o.rz, rr += o.rr, direction += o.direction, kick += o.kick, scale += o.scale;
      return *this;
    }
  };
  struct Loops;  // the parts of solve()

  std::vector<Lanes3> correction_, residual_, image_;  // x - v; r; A p, then M^-1 r. The direction p is in the packs
  std::vector<Blocks> preconditioner_;                 // M^-1: the inverse diagonal blocks of the matrix
  std::vector<Sums> partial_sums_;                     // of dot products, one per cluster
};

}  // namespace flowskin::sph
