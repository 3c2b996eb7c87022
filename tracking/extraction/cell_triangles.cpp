#include "tracking/extraction/cell_triangles.h"

#include <Eigen/Geometry>

#include "tracking/mesh/self_intersections.h"

namespace flowskin::tracking {
namespace {

using Triangles = CellTables::Triangles;

// Whether all triangles look to one side: such a piece of surface does not fold over.
bool faces_one_way(const Triangles& triangles, const std::array<Vec3, 12>& places) {
  std::array<Vec3, 12> areas;  // there are at most ten triangles
  Vec3 sum = Vec3::Zero();
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& [a, b, c] = triangles[t];
    areas[t] = (places[b] - places[a]).cross(places[c] - places[a]);
    sum += areas[t];
  }
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (!(areas[t].dot(sum) > 0)) return false;
  }
  return true;
}

bool intersects_itself(const Triangles& triangles, const std::array<Vec3, 12>& places) {
  for (std::size_t s = 0; s < triangles.size(); ++s) {
    for (std::size_t t = s + 1; t < triangles.size(); ++t) {
      if (triangles_intersect(places, triangles[s], triangles[t])) return true;
    }
  }
  return false;
}

}  // namespace

const Triangles& triangles_of_cell(int pattern, const std::array<Vec3, 12>& places) {
  const auto& all = cell_tables().triangulations[pattern];
  // Two triangles cannot fold over but onto each other.
  if (all.size() < 2 || faces_one_way(all.front(), places)) return all.front();
  for (const Triangles& triangles : all) {
    if (!intersects_itself(triangles, places)) return triangles;
  }
  return all.front();
}

}  // namespace flowskin::tracking
