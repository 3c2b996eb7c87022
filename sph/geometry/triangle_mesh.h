// Indexed triangles as the solver sees them: walls and the outlines of fluid bodies.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace flowskin::sph {

using Vec3 = Eigen::Vector3d;

/// Indexed triangles; positions in m, counter-clockwise seen from outside. Open surfaces are allowed.
struct TriangleMesh {
  std::vector<Vec3> positions;
  std::vector<std::array<int, 3>> triangles;
};

/// Axis-aligned box, both corners in m.
struct Box {
  Vec3 min = Vec3::Zero();
  Vec3 max = Vec3::Zero();
};

}  // namespace flowskin::sph
