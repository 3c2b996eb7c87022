// Mesh fairing with springs of remembered length [FMM13, 3.4]. See docs/fairing.md.
#pragma once

#include <vector>

#include "tracking/advection/projection.h"
#include "tracking/mesh/topology.h"

namespace flowskin::tracking {

struct FairingSettings {
  int iterations = 10;
  double stiffness = 0.3;  ///< Share of the way to the spring equilibrium that an iteration goes, 0 to 1.
};

/// An iteration moves every vertex at once (Jacobi): its one-ring neighbours are projected onto its tangent plane and
/// held fixed; it goes a share of the way to where the springs to them, of the given rest lengths, are in equilibrium,
/// at most a quarter of its shortest edge; then it is put back on the surface by a step of Eq. 12.
/// @param rest_lengths one an edge of the topology (m). Where the springs of a vertex are too long for their ring on
///   the whole, they are shortened together, because compressed springs have no stable equilibrium.
/// @param positions on the surface, or near it.
void fair(const MetaballField& field, const MeshTopology& topology, const std::vector<double>& rest_lengths,
          const FairingSettings& settings, std::vector<Vec3>& positions);

/// The move of one vertex within its tangent plane (m), before projection.
Vec3 fairing_move(int vertex, const Vec3& normal, const MeshTopology& topology, const std::vector<double>& rest_lengths,
                  double stiffness, const std::vector<Vec3>& positions);

}  // namespace flowskin::tracking
