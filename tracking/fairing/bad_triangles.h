// Triangles that must not be written.
#pragma once

#include <vector>

#include "tracking/mesh/adjacency.h"

namespace flowskin::tracking {

/// Whether a triangle is so thin that its normal says nothing.
bool is_degenerate(const Triangle& triangle, const std::vector<Vec3>& positions);

/// Triangles without area, inside out, or folded onto a neighbour. Ascending.
/// @param normals outward normals of the field at the vertices
std::vector<int> bad_triangles(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                               const MeshAdjacency& topology, const std::vector<Vec3>& normals);

}  // namespace flowskin::tracking
