// How far the surface has stretched its material since the first frame.
#pragma once

#include <vector>

#include "tracking/mesh/surface_mesh.h"

namespace flowskin::tracking {

/// Singular values of the linear map from a triangle at rest to the triangle now; 1 and 1 where it moved rigidly.
struct Stretch {
  double largest = 1, smallest = 1;
};

/// One entry a triangle. A triangle without area at rest has the largest value infinity.
std::vector<Stretch> texture_stretch(const SurfaceMesh& mesh);

}  // namespace flowskin::tracking
