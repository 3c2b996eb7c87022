#include "tracking/field/kernel_moments.h"

#include <algorithm>
#include <array>

namespace flowskin::tracking {
namespace {

/// Place of an element of a symmetric tensor: its elements differ in how many of their indices are x, y, z.
int place(int zs, int not_xs) { return not_xs * (not_xs + 1) / 2 + zs; }

template <class... Index>
int place_of(Index... index) {
  return place((static_cast<int>(index == 2) + ...), (static_cast<int>(index > 0) + ...));
}

}  // namespace

StrainResponse KernelMoments::response(int row, int column) const {
  const int a = row, b = column;
  StrainResponse response;
  // phi = u^3: phi_i = -6 u^2 e_i, phi_ij = 24 u e_i e_j - 6 u^2 d_ij,
  // phi_ijk = 24 u (d_ij e_k + d_ik e_j + d_jk e_i) - 48 e_i e_j e_k; each times (A e), summed over the last index.
  response.value = -6 * u2_ee[place_of(a, b)];
  response.gradient[a] = gradient[b];
  for (int i = 0; i < 3; ++i) {
    response.gradient[i] += 24 * u_eee[place_of(i, a, b)];
    response.hessian(i, i) += 24 * u_ee[place_of(a, b)];
    response.hessian(a, i) += 24 * u_ee[place_of(b, i)];
    response.hessian(i, a) += 24 * u_ee[place_of(b, i)];
    for (int j = 0; j < 3; ++j) response.hessian(i, j) -= 48 * eeee[place_of(i, j, a, b)];
  }
  return response;
}

}  // namespace flowskin::tracking
