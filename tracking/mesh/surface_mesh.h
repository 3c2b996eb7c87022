// The tracked surface: an indexed triangle mesh whose vertices carry their material coordinates.
#pragma once

#include <cstdint>
#include <vector>

#include "tracking/particles.h"

namespace flowskin::tracking {

using flowskin::Triangle;

/// Triangles counter-clockwise seen from outside; the vertex arrays have one entry per vertex.
struct SurfaceMesh {
  std::vector<Vec3> positions;       ///< m
  std::vector<Vec3> rest_positions;  ///< Where the vertex's material was in the first frame (m).
  /// Places of the vertices' material at other times (m), each with one entry per vertex: carried along with the mesh
  /// as rest positions are. For whoever wants them; the tracker does not look at them.
  std::vector<std::vector<Vec3>> layers;
  std::vector<Vec3> velocities;    ///< m/s, of the last advection
  std::vector<std::uint64_t> ids;  ///< Persistent; never used again for another vertex.
  std::vector<Triangle> triangles;
  std::uint64_t next_id = 0;  ///< The id of the next vertex to be born.
};

}  // namespace flowskin::tracking
