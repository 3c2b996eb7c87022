// Evens out a mesh along its surface, without memory of its first shape.
#pragma once

#include <vector>

#include "tracking/advection/projection.h"
#include "tracking/mesh/adjacency.h"

namespace flowskin::tracking {

/// Whether vertices on a sharply curved part of the surface may move away from it, which costs volume.
enum class Ridges { ignored, kept };

/// Moves vertices half of the way towards the mean of their one-ring within the tangent plane, then projects them onto
/// the surface. All vertices move at once (Jacobi), each at most 0.3 of its shortest edge. Moves that would turn a
/// triangle inside out are taken back, and a vertex that does not reach the surface stays where it was.
/// @param normals outward unit normals at the vertices, brought up to date.
/// @param vertices the ones that may move; empty: all.
void relax(const ImplicitField& field, const ProjectionSettings& projection, const MeshAdjacency& topology,
           const std::vector<Triangle>& triangles, int iterations, const std::vector<int>& vertices,
           std::vector<Vec3>& positions, std::vector<Vec3>& normals, Ridges ridges = Ridges::ignored);

/// True where the triangle looks away from the normals at all of its corners (more than 78 degrees off), or has no
/// area. One corner is enough to make it upright: across the rim of a thin film the normals turn by up to 180 degrees.
bool is_inverted(const Triangle& triangle, const std::vector<Vec3>& positions, const std::vector<Vec3>& normals);

}  // namespace flowskin::tracking
