// Makes the triangles of a patch fit for tracking.
#pragma once

#include "tracking/repair/replace_region.h"

namespace flowskin::tracking {

/// What is done to the triangles of marching cubes, from much to nothing.
enum class Finish {
  evened,  ///< Short edges are collapsed, edges flipped towards Delaunay, and vertices evened out, in a few rounds.
  merged,  ///< Collapses and flips only.
  raw,     ///< Nothing.
};

/// Collapses short edges into the older vertex, flips towards Delaunay and evens out, as improve_surface does; the only
/// vertices that move or vanish are the patch's new ones. Triangles of the mesh next to the patch may take part in
/// flips: they become triangles of the patch then. Vertices of the hole that fit into the patch where they are take the
/// place of new ones, and so stay in the mesh.
/// @param kept triangles of the mesh near the patch that stay
/// @param frozen new vertices in these cells stay where they are, and the edges at them, too
void improve_patch(const FieldGrid& fresh, const MeshToMend& whole, const std::vector<int>& kept, Finish finish,
                   const CellSet& frozen, MeshPatch& patch);

}  // namespace flowskin::tracking
