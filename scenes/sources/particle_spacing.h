// The distance of neighbouring particles, where nobody tells it.
#pragma once

#include <vector>

#include "sph/geometry/triangle_mesh.h"

namespace flowskin::scenes {

/// Distance of every point of `from` to the nearest other place in `to` (m); with `to` being `from` itself the point
/// is left out. Infinite where there is none.
std::vector<double> nearest_distances(const std::vector<sph::Vec3>& from, const std::vector<sph::Vec3>& to);

/// The value below which a share of the values lie; 0 where there are none.
double quantile(std::vector<double> values, double share);

/// Spacing (m) by the median distance to the nearest neighbour and the volume that 32 neighbours take, over at most
/// some ten thousand particles: the edge of the cube that a particle fills. 0 where there are fewer than two apart.
/// Exact for a lattice; within some per cent for disordered particles, whose nearest neighbours are up to a fifth
/// nearer.
double estimated_spacing(const std::vector<sph::Vec3>& positions);

}  // namespace flowskin::scenes
