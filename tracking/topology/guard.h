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

/// Places of a mesh that are not as they should be, by kind.
struct MeshDefects {
  int off_vertices = 0;   ///< Vertices off the surface.
  int bad_triangles = 0;  ///< Triangles without area, inside out or folded onto a neighbour.
  int long_edges = 0;     ///< Overstretched edges.
  int off_triangles = 0;  ///< Triangles whose middle is off the surface: the mesh cuts through fluid or air.
};

/// Counts the defects of a mesh whose vertices have been projected.
MeshDefects find_defects(const MetaballField& field, const std::vector<Vec3>& positions,
                         const std::vector<Triangle>& triangles, const MeshTopology& topology,
                         const Projection& projection, const GuardSettings& settings);

/// What the guard saw.
struct GuardVerdict {
  std::vector<std::string> reasons;             ///< Why the mesh must be replaced, in words; empty: it fits.
  int components = 0, expected_components = 0;  ///< All of them, small ones included.
  double volume = 0, expected_volume = 0;       ///< m^3
};

/// Compares a mesh with a raw extraction of the same field: defects beyond the tolerated ones, the number of
/// components, the volume, and parts of the surface that the mesh does not cover.
/// @param tolerated the defects a fresh mesh has itself: where the surface has a crease finer than the mesh, another
///   extraction would not help.
GuardVerdict inspect(const SurfaceGeometry& fresh, const std::vector<Vec3>& positions,
                     const std::vector<Triangle>& triangles, const MeshDefects& defects, const MeshDefects& tolerated,
                     const GuardSettings& settings);

/// Triangles that must not be written: without area, inside out, or folded onto a neighbour. Ascending.
std::vector<int> bad_triangles(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                               const MeshTopology& topology, const std::vector<Vec3>& normals);

}  // namespace flowskin::tracking
