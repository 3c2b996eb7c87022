// The Tait equation of state, in terms of the compression e = rho / rho_0 - 1.
#pragma once

namespace flowskin::sph {

/// p = B ((rho / rho_0)^7 - 1) with B = rho_0 c^2 / 7 [Monaghan 1994, Eq. 2.2], multiplied out in powers of the
/// compression e = rho / rho_0 - 1: the difference of two nearly equal numbers never appears, so float is enough.
template <typename Real>
Real tait_pressure_over_bulk(Real e) {
  return e * (Real(7) + e * (Real(21) + e * (Real(35) + e * (Real(35) + e * (Real(21) + e * (Real(7) + e))))));
}

/// p / (rho_0 c^2), not below zero: a free surface does not pull [docs/solver.md, Pressure].
template <typename Real>
Real clamped_pressure(Real e) {
  return e > 0 ? tait_pressure_over_bulk(e) / Real(7) : Real(0);
}

/// p / (rho_0 c^2) of a fluid without free surfaces under a background pressure (in the same unit): below the rest
/// density the pressure falls, down to `least`.
template <typename Real>
Real pressure_with_background(Real e, Real background, Real least = 0) {
  const Real pressure = tait_pressure_over_bulk(e) / Real(7) + background;
  return pressure > least ? pressure : least;
}

}  // namespace flowskin::sph
