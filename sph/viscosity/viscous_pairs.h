// The viscous coefficient of a pair, in one place: the explicit force and the implicit step share the operator.
#pragma once

#include "sph/forces/pair_forces.h"
#include "sph/pairs/lanes.h"

namespace flowskin::sph {

/// Weight k of fluid pairs at the distance q (support radii), the same for all kernels. The textbook forms take |grad
/// W| / r, with few neighbours so steep that the viscosity depends on how they lie: 0.6 of the nominal one on a cubic
/// lattice, 0.9 after shear by half a spacing, 1 on average in bcc and fcc. With this weight: 0.98 to 0.99 under shear,
/// 0.98 to 1.05 in bcc and fcc; but up to 1.3 across the diagonals of a cubic lattice that is turned, not sheared.
inline Float8 viscous_weight(const Float8& q) {
  const Float8 one = broadcast(1.0F), u = max(one - q, Float8{});
  return u * u * u * (one + q);
}

/// Constants of the viscous pair force, in all lanes. The acceleration of particle i by particle j is -k (v_ij . x_ij)
/// x_ij in Monaghan's form and -k r^2 v_ij in Morris's, with the k of fluid() or wall().
struct ViscousPairs {
  Float8 viscosity, wall_viscosity, wall_softening;

  explicit ViscousPairs(const PairCoefficients& c)
      : viscosity(broadcast(c.viscosity)),
        wall_viscosity(broadcast(c.wall_viscosity)),
        wall_softening(broadcast(c.wall_softening)) {}

  /// @param q distance in support radii
  /// @param own,other viscosities of the two (m^2/s), used where `variable`. Their harmonic mean keeps the shear stress
  ///        the same on both sides of an interface [Cleary and Monaghan 1999, for heat conduction].
  template <bool variable>
  Float8 fluid(const Float8& q, const Float8& own, float other) const {
    const Float8 weight = viscosity * viscous_weight(q);
    if constexpr (!variable) return weight;
    constexpr float none = 1e-30F;  // both inviscid: no division by zero
    const Float8 product = broadcast(2 * other) * own, sum = own + broadcast(other + none);
    return weight * product / sum;
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
