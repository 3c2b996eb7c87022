// All walls of a simulation, ready for the pair loop.
#pragma once

#include <vector>

#include "sph/particle_pack.h"
#include "sph/periodic_box.h"
#include "sph/point_clusters.h"
#include "sph/solver.h"
#include "sph/wall_guard.h"
#include "sph/wall_kernel.h"

namespace flowskin::sph {

/// Boundary particles of all walls in the order of a space-filling curve, and the triangles they were made from.
struct BoundaryParticles {
  std::vector<Vec3> positions;   ///< m
  std::vector<double> volumes;   ///< m^3; empty once they are in the packs
  std::vector<double> slips;     ///< 0 to 1; empty once they are in the packs
  std::vector<float> adhesions;  ///< Adhesion times area (m^2) in the order of the packs; empty where no wall attracts.
  std::vector<WallPack> packs;   ///< Positions relative to the origin.
  PointClusters clusters;        ///< Over the packs' positions.
  WallGuard guard;

  std::size_t memory_bytes() const;
};

/// Samples all walls. `packs` and `clusters` stay empty until place_at_origin().
BoundaryParticles sample_boundaries(const std::vector<Boundary>& boundaries, const SolverSettings& settings,
                                    const WallKernel& wall, const PeriodicBox& periodic);

/// Fills packs and clusters with positions relative to `origin`.
void place_at_origin(BoundaryParticles& boundary, const Vec3& origin, const WallKernel& wall);

}  // namespace flowskin::sph
