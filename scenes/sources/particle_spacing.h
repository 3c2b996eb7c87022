// The distance of neighbouring particles, where nobody tells it.
#pragma once

#include <string>
#include <vector>

#include "sph/geometry/triangle_mesh.h"

namespace flowskin::scenes {

/// Distance of every point of `from` to the nearest other place in `to` (m); with `to` being `from` itself the point
/// is left out. Infinite where there is none.
std::vector<double> nearest_distances(const std::vector<sph::Vec3>& from, const std::vector<sph::Vec3>& to);

/// The value below which a share of the values lie; 0 where there are none.
double quantile(std::vector<double> values, double share);

/// The edge of the cube that a particle fills, and how it was found.
struct SpacingEstimate {
  double spacing = 0;          ///< m; 0: fewer than two places
  double uncertainty = 0;      ///< Of the spacing, as a share of it.
  const char* method = "";     ///< In words, for the log.
  std::size_t coincident = 0;  ///< Particles in places that others have, too; they are counted once.
  int dimensions = 3;          ///< 2: all particles lie in a plane; 1: in a line
};

/// By the cell of the lattice, spanned by the three nearest neighbours that are not in a plane, where most particles
/// have the same: exact, sheared and thin lattices included. Otherwise by counting neighbours in balls inside the
/// fluid, where there is an inside, else by the cells with a correction for disorder. At most some ten thousand
/// particles are looked at.
SpacingEstimate estimate_spacing(const std::vector<sph::Vec3>& positions);

/// Its spacing only (m).
double estimated_spacing(const std::vector<sph::Vec3>& positions);

}  // namespace flowskin::scenes
