// How far two surfaces are apart, by sampling of the tests' own: not where the tracker looks.
#pragma once

#include <cstdint>

#include "tracking/extraction/marching_cubes.h"

namespace flowskin::surfaces {

inline constexpr std::uint64_t kSampleSeed = 20140;  ///< Of the random points.
inline constexpr int kSamplesPerTriangle = 12;

/// `count` points spread at random, and evenly by area, over each triangle. They depend on the seed and on nothing but
/// the triangle's number, so the same surface has the same points at any number of threads.
std::vector<tracking::Vec3> random_points(const tracking::SurfaceGeometry& surface, int count, std::uint64_t seed);

/// Largest distance (m) of the random points of each surface, without its components that enclose less than
/// `small_volume` (m^3), to the other surface. 0 where both are empty, infinite where one is.
double dense_hausdorff(const tracking::SurfaceGeometry& first, const tracking::SurfaceGeometry& second,
                       double small_volume, std::uint64_t seed = kSampleSeed);

}  // namespace flowskin::surfaces
