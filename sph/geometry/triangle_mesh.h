// Indexed triangles as the solver sees them: walls and the outlines of fluid bodies.
#pragma once

#include <vector>

#include "common/vectors.h"

namespace flowskin::sph {

using flowskin::Box;
using flowskin::Vec3;

/// Indexed triangles; positions in m, counter-clockwise seen from outside. Open surfaces are allowed.
struct TriangleMesh {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
};

}  // namespace flowskin::sph
