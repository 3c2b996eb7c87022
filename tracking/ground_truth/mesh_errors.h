// How far a tracked mesh is from the truth that the markers and the flow know.
#pragma once

#include "tracking/ground_truth/markers.h"

namespace flowskin::tracking {

/// Of a set of distances (m).
struct ErrorStatistics {
  double median = 0, p90 = 0, rms = 0;
};

/// A mesh against the markers that are on the surface; shares are of these markers.
struct MarkerErrors {
  /// Distance between a marker's rest position and that of the mesh at the point closest to the marker: how far the
  /// texture at this place is from the material at this place, measured on the fluid at rest.
  ErrorStatistics texture;
  double texture_found = 0;  ///< Share of markers that have the mesh within reach, facing the same way.
  /// Distance between a marker and the point of the mesh that carries its material, or, where that is no longer on the
  /// mesh, the material closest to it at rest: how far the texture has been carried astray, measured in space.
  ErrorStatistics path;
  double path_found = 0;  ///< Share of markers whose material is on the mesh, within reach at rest.
  /// Distance between a marker and the vertex on which it started, while that is there and still the same material.
  ErrorStatistics vertex_path;
  double vertices_kept = 0;  ///< Share of markers with such a vertex.
};

/// @param reach farthest distance of closest points, in space and at rest (m)
MarkerErrors marker_errors(const SurfaceMesh& mesh, const Markers& markers, double reach);

/// Mean squares over the surface, weighted by area (m^2/s^2). The tangential ones are of the components along the
/// surface.
struct VelocityErrors {
  double error = 0, tangential_error = 0;  ///< Of mesh.velocities minus flow.
  double flow = 0, tangential_flow = 0;    ///< Of the flow itself.
};

VelocityErrors velocity_errors(const SurfaceMesh& mesh, const Flow& flow);

}  // namespace flowskin::tracking
