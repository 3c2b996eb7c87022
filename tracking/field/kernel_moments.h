// How the field around a point changes when its particles are strained: sums over the particles' places alone.
#pragma once

#include <array>

#include "common/vectors.h"

namespace flowskin::tracking {

/// What an affine motion v(y) = v + A (y - x) of the particles makes of the field at a point x that moves with v,
/// linear in A: D f, D grad f and D Hess f of
///   f_t + grad f . v = D f,  d_t grad f + Hess f v = D grad f,  d_t Hess f + (grad Hess f) v = D Hess f.
/// The particles' places change by A, but each keeps its round kernel. A field that were carried along as a whole would
/// have D f = 0 and D grad f = -A^T grad f; for a spin both are the same.
struct StrainResponse {
  double value = 0;
  Vec3 gradient = Vec3::Zero();
  Mat3 hessian = Mat3::Zero();
};

/// With e = (x - x_i) / sigma and u = 1 - |e|^2, sums over the particles nearer than sigma, without the kernel's
/// weight. Symmetric tensors: each different element once, indices ascending, in lexicographic order.
struct KernelMoments {
  std::array<double, 6> u2_ee{};   ///< u^2 e_a e_b
  std::array<double, 6> u_ee{};    ///< u e_a e_b
  std::array<double, 10> u_eee{};  ///< u e_a e_b e_c
  std::array<double, 15> eeee{};   ///< e_a e_b e_c e_d
  Vec3 gradient = Vec3::Zero();    ///< -6 u^2 e_a: grad f, lengths in sigma

  /// For A with the single element a_rc = 1 (1/s), lengths in sigma.
  StrainResponse response(int row, int column) const;
};

}  // namespace flowskin::tracking
