// Says in words what is wrong with a mesh.
#pragma once

#include <string>
#include <vector>

#include "tracking/mesh/surface_mesh.h"

namespace flowskin::tracking {

/// Of that below, what the triangles alone tell: indices in range, no triangle with a repeated vertex, every edge in
/// exactly two triangles that pass it in opposite directions.
std::vector<std::string> connection_problems(int vertex_count, const std::vector<Triangle>& triangles);

/// What is wrong with a surface, one sentence a kind of fault, each with a count and the first place; empty: it is
/// sound. Sound means: indices in range, positions finite, no unreferenced vertex, no two vertices at the same place,
/// no triangle with a repeated vertex, every edge in exactly two triangles that pass it in opposite directions (closed,
/// oriented), the triangles around every vertex in one fan (two-manifold), every part enclosing a positive volume
/// unless it is a cavity inside another part (outward).
std::vector<std::string> mesh_problems(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles);

/// The same, and that all vertex arrays have one entry per vertex, all of them finite, and ids are unique and below
/// next_id.
std::vector<std::string> mesh_problems(const SurfaceMesh& mesh);

}  // namespace flowskin::tracking
