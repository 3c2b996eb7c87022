// The viscous coefficient of a pair, in one place: the explicit force and the implicit step share the operator.
#pragma once

#include "sph/pair_forces.h"
#include "sph/simd.h"

namespace flowskin::sph {

/// Constants of the viscous pair force, in all lanes. The acceleration of particle i by particle j is -k (v_ij . x_ij)
/// x_ij in Monaghan's form and -k r^2 v_ij in Morris's, with the k of fluid() or wall().
struct ViscousPairs {
  Float8 viscosity, softening, wall_viscosity, wall_softening;

  explicit ViscousPairs(const PairCoefficients& c)
      : viscosity(broadcast(c.viscosity)),
        softening(broadcast(c.softening)),
        wall_viscosity(broadcast(c.wall_viscosity)),
        wall_softening(broadcast(c.wall_softening)) {}

  /// @param shape kernel shape s(q)
  /// @param own,other viscosities of the two (m^2/s), used where `variable`. Their harmonic mean keeps the shear stress
  ///        the same on both sides of an interface [Cleary and Monaghan 1999, for heat conduction].
  template <bool variable>
  Float8 fluid(const Float8& shape, const Float8& r2, const Float8& own, float other) const {
    if constexpr (!variable) return shape * (viscosity / (r2 + softening));
    constexpr float none = 1e-30F;  // both inviscid: no division by zero
    const Float8 product = broadcast(2 * other) * own, sum = own + broadcast(other + none);
    return shape * viscosity * product / (sum * (r2 + softening));
  }

  /// @param shape kernel shape of the walls, times volume and stick of the boundary particle
  template <bool variable>
  Float8 wall(const Float8& shape, const Float8& r2, const Float8& own) const {
    const Float8 k = shape * wall_viscosity / (r2 + wall_softening);
    return variable ? own * k : k;
  }
};

/// Viscosities of the particles of a cluster; lanes without a particle repeat the first one.
inline Float8 load_viscosities(const float* viscosities, std::uint32_t count) {
  Float8 lanes;
  for (std::uint32_t k = 0; k < 8; ++k) lanes[k] = viscosities[k < count ? k : 0];
  return lanes;
}

}  // namespace flowskin::sph
