// Well-distributed sample points with fixed seeds.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/frame_data.h"

namespace flowskin::tools {

/// The first `count` points of the Sobol (0,2) sequence in the unit square, Owen-scrambled by hashing (B. Burley,
/// "Practical Hash-based Owen Scrambling", JCGT 2020). Every aligned run of 2^k points is stratified in itself.
std::vector<Vec2f> scrambled_sobol(int count, std::uint32_t seed);

/// The unit square onto the unit disc, keeping areas and neighbourhoods (P. Shirley and K. Chiu 1997).
Vec2f square_to_disc(const Vec2f& point);

/// Unit vectors about +z with a density proportional to their z (Malley's method: the disc lifted to the hemisphere).
std::vector<Vec3f> cosine_hemisphere(int count, std::uint32_t seed);

/// Unit vectors about `axis`, uniform within `half_angle` (radians).
std::vector<Vec3f> cone_directions(int count, std::uint32_t seed, const Vec3f& axis, float half_angle);

/// A frame about a unit normal; continuous but for one pole (T. Duff et al., "Building an Orthonormal Basis,
/// Revisited", JCGT 2017). Turns a vector about +z into one about `normal`.
inline Vec3f rotate_to(const Vec3f& normal, const Vec3f& local) {
  const float sign = normal.z() < 0 ? -1.0f : 1.0f;
  const float a = -1 / (sign + normal.z()), b = normal.x() * normal.y() * a;
  const Vec3f tangent(1 + sign * normal.x() * normal.x() * a, sign * b, -sign * normal.x());
  const Vec3f bitangent(b, sign + normal.y() * normal.y() * a, -normal.y());
  return local.x() * tangent + local.y() * bitangent + local.z() * normal;
}

/// Which of the 16 interleaved sample sets a pixel uses (A. Keller and W. Heidrich, "Interleaved Sampling", 2001): any
/// 4 by 4 pixels use all of them once. The order is Bayer's, so that pixels side by side have very different sets.
inline int interleaved_set(int x, int y) {
  static constexpr int order[4][4] = {{0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}};
  return order[y & 3][x & 3];
}
inline constexpr int kInterleavedSets = 16;

}  // namespace flowskin::tools
