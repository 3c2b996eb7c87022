// Drops and bubbles that are too small to be shown as they are.
#pragma once

#include <vector>

#include "tracking/mesh/surface_mesh.h"

namespace flowskin::tracking {

/// What becomes of components that enclose too little.
enum class SmallParts {
  keep,   ///< They stay as the field has them.
  drop,   ///< They are left out of the surface.
  balls,  ///< They become balls of the same volume. Their vertices are not on the surface of the field then.
};

/// Moves the vertices of a component, as seen from its centre, onto the sphere around it that makes it enclose the same
/// volume. Left as it is, with false, where a triangle would look the other way: a part with a hole, or much bent.
/// @param volume enclosed (m^3); negative: air
bool make_ball(const std::vector<int>& vertices, const std::vector<Triangle>& triangles, double volume,
               std::vector<Vec3>& positions);

}  // namespace flowskin::tracking
