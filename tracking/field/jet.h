// A field and its derivatives at one point, as far as they tell how its surface moves.
#pragma once

#include <array>

#include "common/vectors.h"

namespace flowskin::tracking {

/// The part of a field that moves, its derivatives in space up to the third order, and the time derivatives of the
/// first three of them. Where no wall is near that is the whole field: moving_value and gradient are then those of
/// ImplicitField::value. Beside a wall the two differ by the wall's share, which says where the surface is but not how
/// it moves.
struct MotionJet {
  double moving_value = 0;                                              ///< f
  Vec3 gradient = Vec3::Zero();                                         ///< f_i (1/m); points into the fluid
  Mat3 hessian = Mat3::Zero();                                          ///< f_ij (1/m^2)
  std::array<Mat3, 3> third{Mat3::Zero(), Mat3::Zero(), Mat3::Zero()};  ///< third[k](i, j) = f_ijk (1/m^3)
  double value_rate = 0;                                                ///< f_t at the fixed point (1/s)
  Vec3 gradient_rate = Vec3::Zero();                                    ///< (1/(m s))
  Mat3 hessian_rate = Mat3::Zero();                                     ///< (1/(m^2 s))
  int neighbors = 0;  ///< Particles whose support covers the point; of a field without particles 0.
};

}  // namespace flowskin::tracking
