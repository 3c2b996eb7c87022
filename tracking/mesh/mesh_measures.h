// Volume, area, components, triangle quality.
#pragma once

#include <vector>

#include "common/triangle.h"
#include "tracking/mesh/adjacency.h"

namespace flowskin::tracking {

/// Volume enclosed by a closed mesh (m^3); cavities count negative.
double mesh_volume(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles);

/// Area (m^2).
double mesh_area(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles);

/// The parts of a mesh that hang together, numbered by their lowest vertex.
struct MeshComponents {
  int count = 0;
  std::vector<int> of_vertex;   ///< Component of each vertex; -1 where no triangle uses it.
  std::vector<double> volumes;  ///< Of each component (m^3); negative: a cavity, or turned inside out.
  std::vector<double> areas;    ///< Of each component (m^2).
};
MeshComponents mesh_components(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles);

/// Vertices - edges + triangles: 2 for each ball, 0 for each torus.
int euler_characteristic(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles);

/// Shape of the triangles.
struct MeshQuality {
  double shortest_edge = 0, mean_edge = 0, longest_edge = 0;  ///< m
  double smallest_angle = 0;                                  ///< Of all triangles (rad).
  double mean_smallest_angle = 0;  ///< Mean over the triangles of the smallest angle of each (rad); 60 degrees at best.
};
/// All zero for an empty mesh.
MeshQuality mesh_quality(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles);

/// Of one triangle (rad).
double smallest_angle(const std::vector<Vec3>& positions, const Triangle& triangle);

/// Smallest angle of each triangle (rad).
std::vector<double> smallest_angles(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles);

/// Share of the triangles whose smallest angle is larger than `angle` (rad); 1 where there are none.
double share_of_angles_above(const std::vector<double>& smallest_angles, double angle);

/// Share of the edges whose length is from `shortest` to `longest` (m); 1 where there are none.
double share_of_edges_within(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                             double shortest, double longest);

/// Unit outward normals, weighted by area; zero where a vertex has no triangle with an area.
std::vector<Vec3> vertex_normals(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles);

}  // namespace flowskin::tracking
