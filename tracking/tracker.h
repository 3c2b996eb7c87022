// Carries a surface mesh along with particles, or with any field: advection, projection, fairing, remeshing, topology.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "tracking/advection/integrator.h"
#include "tracking/field/field_motion.h"
#include "tracking/field/metaballs/metaball_field.h"
#include "tracking/mesh/vertex_attributes.h"
#include "tracking/particles.h"
#include "tracking/repair/small_parts.h"
#include "tracking/velocity/confidence.h"
#include "tracking/velocity/velocity_method.h"

namespace flowskin::tracking {

struct TrackerSettings {
  /// Distance of neighbouring particles (m); must be given. Where a field is tracked that has none it counts for
  /// nothing but edge_length, which then may be given instead.
  double spacing = 0;
  FieldSettings field;  ///< Of particles; radius 0: default_field_settings(spacing).
  std::string velocity = "hybrid";
  Integrator integrator = Integrator::rk2;
  double max_motion = 0.25;        ///< A substep moves no particle further than this share of the effective radius.
  double edge_length = 0;          ///< Edge length of an extracted mesh (m); 0: 0.75 spacings.
  int fairing_iterations = 10;     ///< [FMM13, 3.4]
  double fairing_stiffness = 0.3;  ///< Share of the way to the spring equilibrium an iteration goes, 0 to 1.
  bool fairing_drags = false;      ///< Vertices that fairing moves take their material along [FMM13]; else it stays.
  bool variable_springs = false;   ///< Fairing is soft where the field determines the velocity well.
  double curvature_edges = 0;      ///< Edges at most this multiple of the smaller radius of curvature; 0: all alike.
  bool remeshing = true;           ///< Split, collapse and flip edges of a stretching mesh; false: as in the paper.
  double max_slip = 0;       ///< The texture slips off the particles' material by at most this (m); 0: any distance.
  double smallest_part = 0;  ///< Parts of fluid or air that enclose less (m^3) are small; 0: none is.
  SmallParts small_parts = SmallParts::keep;  ///< What becomes of them.
  bool topology = true;                       ///< Replace the regions where mesh and field disagree.
  bool guard = true;  ///< Replace the whole mesh where that of regions is off, or does not work.
};

/// What happened in the last call of Tracker::advance, and how well the mesh fits now.
struct TrackerReport {
  int substeps = 0;
  bool blended = false;      ///< The field was blended between the two states, since paths are unknown (ParticlePaths).
  double mismatch = 0;       ///< Of that blend (m), see ParticlePaths::mismatch.
  bool reextracted = false;  ///< The guard replaced the mesh.
  std::string reason;        ///< Why, in words; empty where it did not.
  int splits = 0, collapses = 0, flips = 0;  ///< Of the remeshing.
  int regions = 0;                           ///< Replaced where mesh and field disagreed.
  int held_back = 0;                         ///< Vertices whose rest position was held back by max_slip.
  int born = 0;                              ///< Vertices of the replaced regions that are new.
  int balls = 0;                             ///< Small parts that were made balls.
  int components = 0;                        ///< Of the mesh.
  double volume = 0;                         ///< m^3
  double area = 0;                           ///< m^2
  double max_distance = 0;                   ///< Largest |f| / |grad f| at the vertices (m).
  double seconds_velocity = 0, seconds_projection = 0, seconds_fairing = 0, seconds_topology = 0;

  template <class Archive>
  void visit(Archive& archive) {
    archive(substeps, blended, mismatch, reextracted, reason, splits, collapses, flips, regions, held_back, born);
    archive(balls, components, volume, area, max_distance);
    archive(seconds_velocity, seconds_projection, seconds_fairing, seconds_topology);
  }
};

/// The fields of particles and mesh, for archives. Walls are the source's: they do not change, and are not archived.
template <class Archive>
void visit_state(Archive& archive, Particles& p) {
  archive(p.time, p.ids, p.positions, p.velocities, p.rest_positions, p.weights, p.layers, p.has_lasting_ids);
}
template <class Archive>
void visit_state(Archive& archive, SurfaceMesh& m) {
  archive(m.positions);
  for_each_vertex_member(m, [&](Carried, std::string_view, auto& values) { archive(values); });
  archive(m.triangles, m.next_id);
}

/// All that the tracker carries from one call to the next but its settings. What follows from it (field, adjacency) is
/// not here. Whatever a step leaves behind for the next one belongs here, and into visit().
struct TrackerState {
  Particles particles;  ///< Of the last call.
  SurfaceMesh mesh;
  std::vector<double> rest_lengths;  ///< Of the springs [FMM13, 3.4], one per edge (m).
  int tolerated = 0;                 ///< Regions that a fresh mesh did not get right either.
  bool velocities_known = false;     ///< The mesh's velocities are the method's, at the time of the particles.
  TrackerReport report;

  /// For any archive that is called with values and both reads and writes them, such as the simulation's.
  template <class Archive>
  void visit(Archive& archive) {
    archive.section("tracker");
    visit_state(archive, particles);
    visit_state(archive, mesh);
    archive(rest_lengths, tolerated, velocities_known, report);
  }
};

class TrackerImpl;

class Tracker {
 public:
  /// Extracts the first mesh; its rest positions are those of its material: the positions themselves where the
  /// particles are at rest positions, else carried from the particles beneath.
  /// @throws std::invalid_argument where a setting is impossible, or the velocity method needs particle velocities and
  /// there are none.
  Tracker(TrackerSettings settings, const Particles& particles);
  ~Tracker();
  Tracker(Tracker&&) noexcept;
  Tracker& operator=(Tracker&&) noexcept;

  /// The same for a field at a time (s) that is not made of particles: rest positions are the positions.
  /// @throws std::invalid_argument also where the velocity method needs particles.
  Tracker(TrackerSettings settings, std::shared_ptr<const ImplicitField> field, double time);

  /// Carries the mesh from the particles of the last call (or of the constructor) to these. Where their velocities are
  /// unknown or their ids do not last, docs/track.md says what is exact and what is not.
  void advance(const Particles& particles);
  /// Carries the mesh along with a field, from where the last call ended. New surface takes its material from the old
  /// surface alone, as where particles know no rest positions.
  /// @throws std::invalid_argument where this tracker follows particles, or the motion begins at another time.
  void advance(const FieldMotion& motion);

  /// Adds a layer to the mesh: the places where its vertices are now. Particles given from now on should bring theirs.
  void begin_layer();
  /// @throws std::out_of_range where there is no such layer.
  void drop_layer(std::size_t layer);

  const SurfaceMesh& mesh() const;
  /// The field that the mesh is a surface of, now; null where there are no particles.
  std::shared_ptr<const ImplicitField> field() const;
  /// How well the field alone determines the tangential velocity of each vertex, now. Worked out anew by each call.
  std::vector<Confidence> confidence() const;
  const TrackerReport& report() const;
  /// Settings with all automatic values filled in.
  const TrackerSettings& settings() const;

  /// What must be kept to go on later.
  const TrackerState& state() const;
  /// Makes this tracker the one whose state this was: with the same settings all that follows is the same, bit for bit.
  /// The walls stay those of the particles that it was made with; a field that is not made of particles is the one that
  /// it was made with, which must be that at the time of the state.
  /// @throws std::invalid_argument where the state contradicts itself.
  void restore(TrackerState state);

 private:
  std::unique_ptr<TrackerImpl> impl_;
};

}  // namespace flowskin::tracking
