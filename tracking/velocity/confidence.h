// How well the field alone determines the tangential velocity of a surface point.
#pragma once

#include <vector>

#include "tracking/mesh/adjacency.h"
#include "tracking/velocity/surface_point.h"

namespace flowskin::tracking {

/// From 0 (the field looks the same wherever the point slides to) to 1, for the two principal directions of the tangent
/// plane. A ball, a plane and a part covered by one particle have 0 in both, a cylinder along its axis and around it.
struct Confidence {
  double weak = 0;                     ///< Along weak_direction.
  double strong = 0;                   ///< Across it.
  Vec3 weak_direction = Vec3::Zero();  ///< Unit tangent; zero where the field is silent.
};

/// With J the rows of gradient and Hessian of a rigid motion (rigid_rows), the information about the tangential
/// velocity that is left when the spin is free: the Schur complement S = Jv^T (I - P) Jv with P the projection on the
/// columns of the spin. An eigenvalue s of it gives the confidence s / (s + s0); lengths in effective radii, so it is
/// the same at all sizes.
Confidence field_confidence(const SurfacePoint& point);

/// At each vertex.
std::vector<Confidence> field_confidence(const ImplicitField& field, const std::vector<Vec3>& positions);

}  // namespace flowskin::tracking
