// The total velocity of Stam and Schmidt (2011) [FMM13, Eq. 5].
#pragma once

#include "tracking/velocity/surface_point.h"

namespace flowskin::tracking {

/// Components along point.tangents of the velocity that keeps the direction of the gradient (radii per second):
///   (I - n n^T)(d_t grad f + Hess f v) = 0  with  v = normal velocity + tangents a,
/// that is M a = b with M the curvature tensor in the tangent plane. Where it is less curved than `damping` (curvature
/// times effective radius) and the motion is no translation, a goes smoothly to zero: a = M^3 (M^4 + d^4 I)^-1 b. The
/// damping d is `damping` times what a translation by v leaves unexplained of the Hessian's change, from 0 to 1, so
/// that translations are exact.
Vec2 total_tangential_velocity(const SurfacePoint& point, double damping);

}  // namespace flowskin::tracking
