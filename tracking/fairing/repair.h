// Untangles the few bad places of a mesh, so that it need not be replaced as a whole.
#pragma once

#include <vector>

#include "tracking/advection/projection.h"
#include "tracking/mesh/adjacency.h"

namespace flowskin::tracking {

/// Relaxes the surroundings (two rings) of vertices that are off the surface and of degenerate, inverted or folded
/// triangles, a few times with growing effort, until none are left or nothing helps. The rest of the mesh stays as it
/// is.
/// @param projection of the positions as they are; brought up to date.
void repair(const ImplicitField& field, const ProjectionSettings& settings, const MeshAdjacency& topology,
            const std::vector<Triangle>& triangles, std::vector<Vec3>& positions, Projection& projection);

}  // namespace flowskin::tracking
