// Makes the triangles of a patch fit for tracking.
#pragma once

#include "tracking/topology/replace_region.h"

namespace flowskin::tracking {

/// Collapses short edges into the older vertex, flips towards Delaunay and evens out, as improve_surface does; the only
/// vertices that move or vanish are the patch's new ones. Triangles of the mesh next to the patch may take part in
/// flips: they become triangles of the patch then.
/// With Finish::raw nothing is evened out.
/// @param kept triangles of the mesh near the patch that stay
void improve_patch(const FieldGrid& fresh, const MeshToMend& whole, const std::vector<int>& kept, Finish finish,
                   MeshPatch& patch);

}  // namespace flowskin::tracking
