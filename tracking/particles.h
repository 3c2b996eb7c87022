// The particles as the tracker sees them. It never knows where they come from.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "common/vectors.h"

namespace flowskin::tracking {

using flowskin::Mat3;
using flowskin::Vec3;

class Wall;  // tracking/field/metaballs/field_walls.h

/// What the fluid lies on. A wall that moves knows by itself where it is at each time; all states of a source share it.
using Walls = std::vector<std::shared_ptr<const Wall>>;

/// Particles at one time, in order of ascending id; all arrays have one entry per particle. From a recording, less may
/// be known: docs/track.md says what the tracker makes of it.
struct Particles {
  double time = 0;  ///< s
  std::vector<std::uint64_t> ids;
  std::vector<Vec3> positions;       ///< m
  std::vector<Vec3> velocities;      ///< m/s; empty: unknown
  std::vector<Vec3> rest_positions;  ///< Place of the material in the first frame (m); empty: unknown.
  std::vector<double> weights{};     ///< Share of each in the field; empty: 1 each.
  /// Places of the material at other times (m), those that SurfaceMesh::layers stand for, in the same order: one entry
  /// per particle, or none: unknown.
  std::vector<std::vector<Vec3>> layers{};
  bool has_lasting_ids = true;  ///< An id names the same particle in the next state; false: it only counts.
  Walls walls{};                ///< Empty: there are none, or none that the surface should know of.
};

}  // namespace flowskin::tracking
