// Finds out whether a tracked mesh still fits the field. See docs/guard.md.
#pragma once

#include <string>
#include <vector>

#include "tracking/advection/projection.h"
#include "tracking/extraction/marching_cubes.h"
#include "tracking/mesh/topology.h"

namespace flowskin::tracking {

/// Limits; lengths in metres.
struct GuardSettings {
  double tolerance = 0;             ///< Largest |f| / |grad f| at a vertex.
  double longest_edge = 0;          ///< A longer edge is overstretched.
  double reach = 0;                 ///< A fresh vertex farther from the tracked mesh than this is not covered by it.
  double sagitta = 0;               ///< The middle of a triangle may be this far off the surface.
  double small_volume = 0;          ///< Components that enclose less (m^3) are not counted.
  double volume_tolerance = 0.015;  ///< Relative difference of the enclosed volumes.
};

/// tolerance 1e-4 radii, longest_edge 4, reach 1.25 and sagitta 0.6 edge lengths, small_volume 4 spacings cubed.
GuardSettings default_guard(double spacing, double edge_length, const FieldSettings& field);

/// What the guard saw.
struct GuardVerdict {
  std::vector<std::string> reasons;             ///< Why the mesh must be replaced, in words; empty: it fits.
  int components = 0, expected_components = 0;  ///< All of them, small ones included.
  double volume = 0, expected_volume = 0;       ///< m^3
};

/// Compares a mesh, whose vertices have been projected, with a raw extraction of the same field. Looks for vertices and
/// triangles off the surface, triangles without area, inside out or folded onto a neighbour, overstretched edges, a
/// different number of components, another volume, and parts of the surface that the mesh does not cover.
GuardVerdict inspect(const MetaballField& field, const SurfaceGeometry& fresh, const std::vector<Vec3>& positions,
                     const std::vector<Triangle>& triangles, const MeshTopology& topology, const Projection& projection,
                     const GuardSettings& settings);

/// Triangles that must not be written: without area, inside out, or folded onto a neighbour. Ascending.
std::vector<int> bad_triangles(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                               const MeshTopology& topology, const std::vector<Vec3>& normals);

}  // namespace flowskin::tracking
