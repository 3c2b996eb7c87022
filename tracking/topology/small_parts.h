// Parts of the surface too small to be held by the mesh.
#pragma once

#include <vector>

#include "tracking/advection/projection.h"
#include "tracking/mesh/surface_mesh.h"

namespace flowskin::tracking {

/// Removes components that enclose less than `small_volume` (m^3) and are spoilt: they enclose nothing or are inside
/// out, have a vertex off the surface, or one of the bad triangles. A drop below the resolution that shrinks or
/// vanishes so costs only itself, not the mesh. Bubbles count as inside out. Returns whether anything was removed.
/// @param projection of the mesh's vertices
/// @param bad triangles that must not be written
bool drop_spoilt_parts(const Projection& projection, const std::vector<int>& bad, double small_volume,
                       SurfaceMesh& mesh);

}  // namespace flowskin::tracking
