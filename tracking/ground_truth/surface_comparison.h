// A surface against the one it should be: the same pieces, holes, volume and place.
#pragma once

#include "tracking/extraction/marching_cubes.h"

namespace flowskin::tracking {

/// What a closed surface is made of. Small components are those whose volume is below the limit given; they are among
/// the components, and their share of the Euler characteristic is in it.
struct SurfaceShape {
  int components = 0, small_components = 0;
  int euler = 0, small_euler = 0;  ///< Vertices - edges + triangles.
  int borderline = 0;              ///< Components within a factor of two of the limit.
  double volume = 0;               ///< Enclosed (m^3); cavities count negative.
};

/// @param small_volume Components that enclose less, as drops or as cavities (m^3), are small.
SurfaceShape surface_shape(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                           double small_volume = 0);

/// A mesh and a fresh extraction of the same field.
struct SurfaceComparison {
  SurfaceShape mesh, fresh;
  double hausdorff = 0;  ///< See hausdorff_distance (m), of all but the small components to the other surface.

  /// Same number of components and same Euler characteristic, small components left out: those below the resolution
  /// may be there or not, and one close to the limit may be small in one surface and not in the other.
  bool same_topology() const {
    const int components = (mesh.components - mesh.small_components) - (fresh.components - fresh.small_components);
    const int euler = (mesh.euler - mesh.small_euler) - (fresh.euler - fresh.small_euler);
    const int borderline = mesh.borderline > fresh.borderline ? mesh.borderline : fresh.borderline;
    return euler == 2 * components && components <= borderline && -components <= borderline;
  }
  /// Volume of the mesh over that of the fresh extraction, minus one; 0 where both are empty.
  double volume_error() const;
};

/// @param small_volume as above; the cube of the edge length for features under one cell
SurfaceComparison compare_surfaces(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                                   const SurfaceGeometry& fresh, double small_volume = 0);

}  // namespace flowskin::tracking
