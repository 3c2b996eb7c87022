// What is behind sph::Solver: one step is step(), the rest are its parts in order.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/state_archive.h"
#include "sph/bodies/jet_emitter.h"
#include "sph/forces/pair_forces.h"
#include "sph/forces/surface_tension.h"
#include "sph/geometry/periodic_box.h"
#include "sph/neighbors/hilbert_order.h"
#include "sph/neighbors/neighbor_lists.h"
#include "sph/setup/simulation_setup.h"
#include "sph/solver/particle_arrays.h"
#include "sph/solver/statistics.h"
#include "sph/viscosity/implicit_viscosity.h"
#include "sph/walls/boundary_particles.h"
#include "sph/walls/wall_drag.h"

namespace flowskin::sph {

class SolverImpl {
 public:
  explicit SolverImpl(SimulationSetup setup);

  bool advance_towards(double time, const std::function<bool()>& stop);
  double step(double limit);

  double time() const { return time_; }
  const ParticleArrays& particles() const { return particles_; }
  const BoundaryParticles& boundary() const { return boundary_; }
  const SolverSettings& settings() const { return settings_; }
  const SolverStatistics& statistics() const { return statistics_; }
  const std::vector<std::string>& warnings() const { return warnings_; }
  const PeriodicBox& periodic() const { return periodic_; }
  double particle_mass() const { return mass_; }
  std::size_t memory_bytes() const;

  void save(StateWriter& writer) const;
  void restore(StateReader& reader);

 private:
  /// All that the next step depends on, but the set-up and what follows from the rest: lists and clusters are functions
  /// of the positions at their last build, packs' places in memory of the order of the particles. Whatever a step
  /// leaves behind for the next one belongs here: tests/sph/restart_test.cpp compares each feature with and without a
  /// stop.
  /// @param places of the particles at the last build of the lists, relative to the origin
  template <class Archive>
  void visit(Archive& archive, std::vector<Eigen::Vector3f>& places) {
    archive.section("solver");
    archive(time_, next_id_, particles_);
    archive.each(emitters_);
    archive(places, boundary_.build_time(), particles_changed_, builds_since_sort_);
    archive(greatest_speed_, greatest_acceleration_, some_outside_, statistics_);
    if (wall_drag_.active()) archive(wall_drag_.wet_since());
  }

  /// Whether what was restored fits together and to the set-up.
  bool is_consistent(const std::vector<Eigen::Vector3f>& places);

  TimeStepReport choose_step(double limit) const;
  /// Implicit viscosity: the velocities at the end of the step, all forces included.
  void kick_implicitly(double dt);
  /// First half of the kick, then the drift, with the wall guard; fills the packs with the state that forces are needed
  /// of.
  void kick_and_drift(double dt);
  bool is_implicit() const { return settings_.viscosity_solver == ViscositySolver::implicit; }
  Hold drift_particle(std::size_t i, std::size_t cluster, double dt);
  void fill_pack(std::size_t i, double dt);
  void add_particle(const Vec3& position, const Vec3& velocity, const Vec3& rest_position, std::size_t fluid);
  void pour_emitters();
  bool some_to_drain() const;
  /// Takes out what has left the domain or is in a sink.
  void remove_lost();
  void wrap_particles();
  /// Whether some pair may have come into reach that is not in the lists.
  bool lists_outdated() const;
  void rebuild_lists();
  /// Clusters and lists of the particles at these places.
  void build_lists(const PointView& places);
  void collect_wall_triangles();
  void evaluate_forces();
  /// Viscosities of fluids that depend on the shear rate, from the velocities in the packs.
  void update_viscosities(const PairData& data);
  /// Second half of the kick, the compression, and the limits of what is believable.
  void finish_step(double dt);
  /// Where the fluid fills its space its volume cannot change, but the continuity equation drifts as the particles'
  /// order changes: the drift of the mean is not pressure.
  void take_out_mean_compression();
  [[noreturn]] void throw_blow_up(std::size_t particle) const;
  const JetEmitter* nozzle_around(const Vec3& p) const;

  SolverSettings settings_;
  std::vector<Fluid> fluids_;     // empty: one Newtonian fluid
  bool shear_dependent_ = false;  // some fluid's viscosity depends on the shear rate
  PeriodicBox periodic_;
  double mass_ = 0, smoothing_length_ = 0;
  double time_ = 0;
  Vec3 origin_ = Vec3::Zero();  // of the float coordinates
  WallKernel wall_kernel_;
  PairCoefficients coefficients_;
  SurfaceTension surface_tension_;
  WallDrag wall_drag_;
  std::vector<SurfaceStress> surface_stresses_;  // empty without surface tension
  std::vector<JetEmitter> emitters_;
  std::vector<Sink> sinks_;
  BoundaryParticles boundary_;
  bool sees_walls_ = false;  // thin walls hide fluid from fluid
  ParticleArrays particles_;
  std::uint64_t next_id_ = 0;

  // Neighbour search. The clusters keep the places of the last build, which tell how far particles have moved since.
  HilbertOrder curve_;
  PointClusters clusters_;
  NeighborLists fluid_lists_, wall_lists_;
  NeighborLists tension_lists_, adhesion_lists_;  // empty without surface tension, without adhesion
  bool particles_changed_ = true;                 // added or removed since the last build
  int builds_since_sort_ = 0;

  ImplicitViscosity implicit_viscosity_;
  double greatest_speed_ = 0, greatest_acceleration_ = 0;
  std::vector<std::string> warnings_;
  bool some_outside_ = false;
  SolverStatistics statistics_;
};

}  // namespace flowskin::sph
