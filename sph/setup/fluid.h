// The fluids of a set-up.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "common/range.h"

namespace flowskin::sph {

/// How the viscosity depends on the shear rate g = sqrt(2 D:D): Herschel and Bulkley's law, regularised by
/// Papanastasiou [1987], eta = K g^(n - 1) + tau_y (1 - exp(-m g)) / g, at most rest density times max_viscosity.
struct Rheology {
  double consistency = 0;       ///< K (Pa s^n); 0: n = 1 and K = rest density times viscosity
  double flow_index = 1;        ///< n; below 1 thinner, above 1 thicker when sheared
  double yield_stress = 0;      ///< tau_y (Pa): below it the fluid hardly flows
  double regularization = 100;  ///< m (s): yields above shear rates of about 1/m
  double max_viscosity = 10;    ///< Kinematic (m^2/s); of all that does not yield

  bool is_newtonian() const { return consistency == 0 && yield_stress == 0; }
};

using RheologyNumber = NamedNumber<Rheology>;
/// What the numbers of a rheology may be, in scene files and in set-ups made by a program alike.
/// Upper ends only catch slips, but for the flow index: shear-thickening fluids have up to about 2.
inline constexpr std::array kRheologyNumbers{
    RheologyNumber{"consistency", &Rheology::consistency, at_least(0, 1e9), "Pa s^n"},
    RheologyNumber{"flow_index", &Rheology::flow_index, above(0, 5), ""},
    RheologyNumber{"yield_stress", &Rheology::yield_stress, at_least(0, 1e9), "Pa"},
    RheologyNumber{"regularization", &Rheology::regularization, above(0, 1e9), "s"},
    RheologyNumber{"max_viscosity", &Rheology::max_viscosity, above(0, 1e4), "m^2/s"},
};
consteval Range range_of(double Rheology::*value) { return range_in(kRheologyNumbers, value); }

/// One of the fluids of a set-up. All have the rest density of the settings.
struct Fluid {
  std::string name;         ///< By which bodies and emitters refer to it.
  double viscosity = 1e-6;  ///< Kinematic viscosity (m^2/s), laminar.
  Rheology rheology;
};

}  // namespace flowskin::sph
