// Where a surface passes through itself.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "tracking/mesh/surface_mesh.h"

namespace flowskin::tracking {

/// The pairs of triangles (lower index first, ascending) that have a point in common which is not on an edge or a
/// vertex that they share by its index. So these count too: triangles that only touch without sharing a vertex,
/// triangles that lie in one plane and overlap, neighbours folded flat onto each other, neighbours at a vertex of which
/// one pierces the other, and triangles with the same three vertices. A triangle without area is the segment or point
/// that its corners span; it does not count by itself.
///
/// Decided exactly, without tolerance: sheets at a distance of 1e-12 do not meet. Coordinates smaller than 1e-60 m
/// count as zero. O(n log n) for n triangles of a surface in the usual sense; on all threads, with the same result at
/// any number of them.
/// @throws std::invalid_argument naming the first vertex that is not finite or beyond 1e60 m, or the first triangle
/// with a vertex index out of range or twice.
std::vector<std::array<int, 2>> self_intersections(const std::vector<Vec3>& positions,
                                                   const std::vector<Triangle>& triangles);

/// The same for two triangles: whether they have a point in common that is not on an edge or a vertex that they share.
/// @pre All coordinates are 0 or between 1e-60 and 1e60 m, and each triangle has three different vertices.
bool triangles_intersect(std::span<const Vec3> positions, Triangle first, Triangle second);

}  // namespace flowskin::tracking
