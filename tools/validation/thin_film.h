// Spreading of a thin sheet of viscous fluid by its weight: the lubrication equation, solved on a grid of rings.
#pragma once

#include <vector>

namespace flowskin::tools {

/// A cylinder of fluid that spreads on a no-slip plane as lubrication theory has it,
/// dh/dt = g / (3 nu) 1/r d/dr (r h^3 dh/dr) [Huppert 1982, Eq. 2.4], up to its start: no similarity is assumed.
struct SpreadingCylinder {
  double radius = 1, height = 1;  ///< At the start (m).
  double gravity = 10;            ///< m/s^2
  double viscosity = 1;           ///< Kinematic (m^2/s).
  double farthest = 4;            ///< Solved until the front is there (m).
  int rings = 800;                ///< From the axis to the farthest front.
};

/// Time (s) and radius of the front (m), ascending. Finite volumes, implicit in time.
struct SpreadingFront {
  std::vector<double> times, radii;
  /// By linear interpolation (m).
  double radius_at(double time) const;
};

SpreadingFront spread(const SpreadingCylinder& cylinder);

}  // namespace flowskin::tools
