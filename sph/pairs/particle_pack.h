// What the pair loop reads of each particle: 32 bytes, so that a neighbour is one cache line access.
#pragma once

namespace flowskin::sph {

/// A fluid particle in the pair loop. Positions are relative to the solver's origin, so that float is precise enough.
struct alignas(32) FluidPack {
  using plain_numbers = float;
  float x, y, z;      ///< m
  float vx, vy, vz;   ///< m/s
  float compression;  ///< rho / rho_0 - 1
  float pressure;     ///< p / rho^2 times the factors that all pairs share (PairCoefficients::pack_pressure)
};

/// A boundary particle in the pair loop.
struct alignas(16) WallPack {
  float x, y, z;                 ///< m
  float volume;                  ///< V_b [AIA*12, Eq. 4] over the cube of the wall's support radius
  float stick;                   ///< 1 - slip
  float vx = 0, vy = 0, vz = 0;  ///< m/s; of the wall or of a surface that runs along on it
};

}  // namespace flowskin::sph
