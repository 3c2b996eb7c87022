// Motions of all vertices at once: what the field says at each, and edges that keep neighbours together.
#pragma once

#include <vector>

#include "tracking/field/implicit_field.h"
#include "tracking/mesh/adjacency.h"
#include "tracking/velocity/motion_rows.h"

namespace flowskin::tracking {

/// Weights of the least-squares problem; lengths in effective radii, so they serve scenes of any size.
struct CouplingWeights {
  RowWeights rows;
  double velocity = 1;  ///< lambda: an edge d obeys v_i - v_j = (A_i + A_j) d / 2; the row is divided by |d|.
  double gradient = 1;  ///< mu: the ends of an edge have the same gradient.
};

struct SolverLimits {
  double tolerance = 1e-4;  ///< Of the residual, relative to that of no motion.
  int max_iterations = 1000;
};

/// How the last solution was found.
struct CouplingReport {
  int iterations = 0;
  double residual = 0;  ///< Relative to that of no motion.
};

/// Velocity of every vertex (m/s) by least squares over
///   the field's rows at the vertices (MotionRows, for the methods rigid-global and affine),
///   lambda / |d|^2 |v_i - v_j - (A_i + A_j) d / 2|^2 + mu |A_i - A_j|^2 for the edges d = x_i - x_j.
/// Preconditioned conjugate gradients, blocks of a vertex on the diagonal, without a matrix; started from the one
/// motion of each component that fits its field best. Takes time linear in the vertices. Nothing is remembered from
/// call to call: the result depends on the arguments alone.
template <class Motion>
CouplingReport coupled_velocities(const ImplicitField& field, const MeshAdjacency& topology,
                                  const std::vector<Vec3>& positions, const CouplingWeights& weights,
                                  const SolverLimits& limits, std::vector<Vec3>& velocities);

extern template CouplingReport coupled_velocities<RigidMotion>(const ImplicitField&, const MeshAdjacency&,
                                                               const std::vector<Vec3>&, const CouplingWeights&,
                                                               const SolverLimits&, std::vector<Vec3>&);
extern template CouplingReport coupled_velocities<AffineMotion>(const ImplicitField&, const MeshAdjacency&,
                                                                const std::vector<Vec3>&, const CouplingWeights&,
                                                                const SolverLimits&, std::vector<Vec3>&);

}  // namespace flowskin::tracking
