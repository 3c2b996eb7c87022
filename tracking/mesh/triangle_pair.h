// Whether two triangles meet: decided exactly.
#pragma once

#include <array>

#include "tracking/particles.h"

namespace flowskin::tracking {

/// The corners of a triangle, its border and the area in it included. The corners may lie on a line or coincide: then
/// it is the segment or the point that they span.
using Corners = std::array<Vec3, 3>;

/// Whether two triangles have a point in common. Never wrong for the coordinates of orientation.h.
bool triangles_meet(const Corners& first, const Corners& second);

/// Whether two triangles that share their first corner have any other point in common.
bool triangles_meet_beyond_corner(const Corners& first, const Corners& second);

/// Whether two triangles that share the edge between their first two corners have a point in common that is not on it:
/// they are folded onto each other.
bool triangles_meet_beyond_edge(const Corners& first, const Corners& second);

}  // namespace flowskin::tracking
