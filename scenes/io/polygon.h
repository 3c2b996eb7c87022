// Cutting polygons into triangles.
#pragma once

#include <array>
#include <vector>

#include "sph/geometry/triangle_mesh.h"

namespace flowskin::scenes {

/// Cuts the polygon of the vertices `corners` into corners.size() - 2 triangles of the same winding by clipping ears,
/// so that a planar polygon need not be convex. Takes O(n^2) time or, for polygons with very many reflex corners,
/// O(n^3). A polygon that has no ear left (it crosses itself, or is not flat) is finished as a fan.
std::vector<std::array<int, 3>> triangulate_polygon(const std::vector<sph::Vec3>& positions, std::vector<int> corners);

}  // namespace flowskin::scenes
