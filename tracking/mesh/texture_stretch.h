// How far the surface has stretched its material since the first frame.
#pragma once

#include <vector>

#include "tracking/mesh/surface_mesh.h"

namespace flowskin::tracking {

/// Singular values of the linear map from a triangle at rest to the triangle now; 1 and 1 where it moved rigidly.
struct Stretch {
  double largest = 1, smallest = 1;
};

/// By how much the texture looks wrong: the largest singular value, or one over the smallest; at least 1.
double distortion(const Stretch& stretch);

/// From `places` of the vertices' material (m), one per vertex, to the present, one entry per triangle. A triangle
/// without area at these places has the largest value infinity.
std::vector<Stretch> texture_stretch(const SurfaceMesh& mesh, const std::vector<Vec3>& places);

/// The same from rest positions.
std::vector<Stretch> texture_stretch(const SurfaceMesh& mesh);

}  // namespace flowskin::tracking
