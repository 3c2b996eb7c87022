// Differences of positions in the pair loops; in a periodic box to the nearest image.
#pragma once

#include "sph/forces/pair_forces.h"
#include "sph/pairs/lanes.h"

namespace flowskin::sph {

struct Difference {
  Float8 x, y, z;
};

/// The periods, in all lanes.
struct MinimumImage {
  Float8 period[3], inverse_period[3];

  explicit MinimumImage(const PairCoefficients& c) {
    for (int a = 0; a < 3; ++a) {
      period[a] = broadcast(c.period[a]);
      inverse_period[a] = broadcast(c.inverse_period[a]);
    }
  }

  /// x_i - x_j of eight particles i, one per lane, and one j.
  template <bool periodic, typename Pack>
  Difference difference(const Float8& x, const Float8& y, const Float8& z, const Pack& j) const {
    Difference d{x - broadcast(j.x), y - broadcast(j.y), z - broadcast(j.z)};
    if constexpr (periodic) {
      d.x -= period[0] * round8(d.x * inverse_period[0]);
      d.y -= period[1] * round8(d.y * inverse_period[1]);
      d.z -= period[2] * round8(d.z * inverse_period[2]);
    }
    return d;
  }
};

}  // namespace flowskin::sph
