// Mesh fairing with springs of remembered length [FMM13, 3.4]. See docs/fairing.md.
#pragma once

#include <vector>

#include "tracking/advection/projection.h"
#include "tracking/mesh/adjacency.h"
#include "tracking/velocity/confidence.h"

namespace flowskin::tracking {

struct FairingSettings {
  int iterations = 10;
  double stiffness = 0.3;  ///< Share of the way to the spring equilibrium that an iteration goes, 0 to 1.
};

/// An iteration moves every vertex at once (Jacobi): its one-ring neighbours are laid into its tangent plane and held
/// fixed; it goes a share of the way to where the springs to them, of the given rest lengths, are in equilibrium, at
/// most a quarter of its shortest edge; then it is put back on the surface by a step of Eq. 12.
/// @param rest_lengths one per edge of the topology (m). Where the springs of a vertex are too long for their ring on
///   the whole, they are shortened together, because compressed springs have no stable equilibrium.
/// @param confidence how well the velocity of each vertex was determined; empty: constant springs, the paper's method.
///   Else the springs are soft where it was well determined: a vertex goes only the share 1 - confidence of its way, in
///   each of the two directions of the tangent plane; and neighbours keep their distance when they are laid into the
///   plane (the paper projects them, which shortens them on a curved surface), so that a mesh whose edges all have
///   their rest lengths does not move.
/// @param positions on the surface, or near it.
void fair(const ImplicitField& field, const MeshAdjacency& topology, const std::vector<double>& rest_lengths,
          const FairingSettings& settings, const std::vector<Confidence>& confidence, std::vector<Vec3>& positions);
/// The same with the neighbourhoods of the positions, or of places near them; best with the usual slack.
void fair(const Neighborhoods& neighborhoods, const MeshAdjacency& topology, const std::vector<double>& rest_lengths,
          const FairingSettings& settings, const std::vector<Confidence>& confidence, std::vector<Vec3>& positions);

/// How neighbours come into the tangent plane of a vertex: projected, or turned at their distance.
enum class Laying { projected, turned };

/// The springs of a mesh.
struct SpringMesh {
  const MeshAdjacency& topology;
  const std::vector<double>& rest_lengths;  ///< One per edge (m).
  Laying laying = Laying::projected;
  double stiffness = 0.3;  ///< As in FairingSettings.
};

/// The move of one vertex within its tangent plane (m), before projection.
Vec3 fairing_move(const SpringMesh& mesh, int vertex, const Vec3& normal, const std::vector<Vec3>& positions);

}  // namespace flowskin::tracking
