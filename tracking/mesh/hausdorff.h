// How far two surfaces are apart where they are farthest apart.
#pragma once

#include <vector>

#include "tracking/mesh/surface_mesh.h"

namespace flowskin::tracking {

/// Two-sided Hausdorff distance of two meshes (m), sampled: the largest distance of a vertex or triangle centre of
/// either to the nearest point of the other's triangles. The true distance is larger by no more than a point of a
/// triangle can be from all of its samples: a third of the edge length where triangles are equilateral. 0 where both
/// are empty, infinite where one is. The same at any number of threads.
double hausdorff_distance(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                          const std::vector<Vec3>& other_positions, const std::vector<Triangle>& other_triangles);

/// One side of it: the largest distance of a sample of the first mesh to the second.
double one_sided_distance(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                          const std::vector<Vec3>& other_positions, const std::vector<Triangle>& other_triangles);

}  // namespace flowskin::tracking
