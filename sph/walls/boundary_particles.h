// All walls of a simulation, ready for the pair loop.
#pragma once

#include <vector>

#include "sph/geometry/periodic_box.h"
#include "sph/neighbors/point_clusters.h"
#include "sph/pairs/particle_pack.h"
#include "sph/setup/simulation_setup.h"
#include "sph/walls/boundary_sampling.h"
#include "sph/walls/moving_wall.h"
#include "sph/walls/thin_walls.h"
#include "sph/walls/wall_guard.h"
#include "sph/walls/wall_kernel.h"

namespace flowskin::sph {

/// Boundary particles of all walls, those of resting walls first, then those of each moving one, each group in the
/// order of a space-filling curve; and the triangles they were made from.
class BoundaryParticles {
 public:
  BoundaryParticles() = default;
  /// Samples all walls, where they are at time 0. Nothing but positions() is there before place_at_origin().
  BoundaryParticles(const std::vector<Boundary>& boundaries, const SolverSettings& settings, const WallKernel& wall,
                    const PeriodicBox& periodic);
  /// Fills packs and clusters with positions relative to `origin`.
  void place_at_origin(const Vec3& origin);

  const std::vector<Vec3>& positions() const { return positions_; }  ///< m
  const std::vector<WallPack>& packs() const { return packs_; }      ///< Positions relative to the origin.
  const PointClusters& clusters() const { return clusters_; }        ///< As they were at the last mark_build().
  /// Adhesion times area (m^2) in the order of the packs; empty where no wall attracts.
  const std::vector<float>& adhesions() const { return adhesions_; }
  bool empty() const { return positions_.empty(); }
  double greatest_speed() const { return greatest_speed_; }  ///< Of all walls and surfaces, ever (m/s).

  /// Takes the moving walls to where they are at `time` (s).
  void move_to(double time);
  /// Time of the last mark_build() (s); part of the saved state.
  double& build_time() { return build_time_; }
  /// Farthest way (m) that a wall has gone since mark_build().
  double shift_since_build() const;

  /// Prepares for lists of fluid clusters: call when they are built, then collect_triangles() for each cluster that is
  /// near walls, with its box (m), in parallel if you like. Up to the next time, no particle may go farther than the
  /// margin (m), relative to the wall.
  void mark_build(std::size_t fluid_clusters);
  void collect_triangles(std::size_t cluster, const Vec3& low, const Vec3& high, double margin);

  /// Puts the end of a particle's path back where it would pass a wall or come into a gap that it does not fit into,
  /// and takes its velocity in that direction away.
  /// @param nearest distance from the start to the nearest boundary particle (m)
  Hold hold(const Vec3& from, std::size_t cluster, double nearest, Vec3& target, Vec3& velocity) const {
    const bool far = nearest >= coverage_radius * sample_spacing_ + (target - from).norm() + last_shift_;
    if (far && near_gap_[cluster] == NearGap::none) return {};
    return hold_near(from, cluster, target, velocity);
  }

  /// Whether some wall is so thin that fluid on one side of it could feel fluid on the other.
  bool has_thin() const;
  /// Sets bit k of hidden[j] where such a wall is between point k of a cluster and point sources[j]; false where none
  /// is near.
  /// @param places of all points, relative to the origin
  bool hide(const PointClusters& points, const PointView& places, std::size_t cluster,
            std::span<const std::uint32_t> sources, std::vector<std::uint8_t>& hidden) const;

  std::size_t memory_bytes() const;

 private:
  void append_samples(const std::vector<Vec3>& samples, const Boundary& boundary);
  void scale_adhesions(const SolverSettings& settings, const WallKernel& wall);
  Hold hold_near(const Vec3& from, std::size_t cluster, Vec3& target, Vec3& velocity) const;
  bool keep_out(const Vec3& from, std::size_t cluster, Vec3& target, Vec3& velocity) const;
  /// Whether gaps between walls that move and others may be near; if so their triangles are collected.
  bool collect_between(std::size_t cluster, const Vec3& low, const Vec3& high, double margin);
  bool keep_out_between(const Vec3& from, std::size_t cluster, Vec3& target, Vec3& velocity) const;
  bool stops(const Vec3& from, std::size_t cluster, const Vec3& target) const;
  Hold hold_between(const Vec3& from, std::size_t cluster, Vec3& target, Vec3& velocity) const;

  enum class NearGap : std::uint8_t { none, within, between };  // in some wall; also between those that move and others

  double sample_spacing_ = 0, support_ = 0;  // m, of the walls' kernel
  double gap_width_ = 0;                     // m
  PeriodicBox periodic_;
  Vec3 origin_ = Vec3::Zero();
  std::vector<Vec3> positions_;           // m
  std::vector<double> volumes_;           // m^3; empty once they are in the packs
  std::vector<double> slips_;             // 0 to 1; empty once they are in the packs
  std::vector<Vec3> surface_velocities_;  // m/s; empty once they are in the packs
  std::vector<float> adhesions_;
  std::vector<WallPack> packs_;
  PointClusters clusters_;
  WallGuard guard_;                                    // of the resting walls
  ThinWalls thin_;                                     // of the resting walls
  std::vector<std::vector<std::uint32_t>> triangles_;  // of the resting walls: one list per cluster
  std::vector<MovingWall> movers_;
  std::vector<NearGap> near_gap_;  // one entry per cluster
  double greatest_speed_ = 0, last_shift_ = 0, build_time_ = 0, time_ = 0;
};

}  // namespace flowskin::sph
