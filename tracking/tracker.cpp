#include "tracking/tracker.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "tracking/advection/particle_paths.h"
#include "tracking/advection/projection.h"
#include "tracking/extraction/extract_surface.h"
#include "tracking/fairing/fairing.h"
#include "tracking/fairing/repair.h"
#include "tracking/mesh/mesh_measures.h"
#include "tracking/mesh/topology.h"
#include "tracking/remeshing/remesh.h"
#include "tracking/topology/guard.h"
#include "tracking/topology/material.h"
#include "tracking/topology/small_parts.h"

namespace flowskin::tracking {
namespace {

constexpr double kDefaultEdgeInSpacings = 0.75;
constexpr int kMostSubsteps = 1000;
constexpr int kUntanglingRounds = 4;
constexpr double kLongestJump = 4;  // of a particle between two states, in effective radii
constexpr double kFarReach = 2;     // of old material where particles know none, in effective radii

// Adds the time until its end to a sum.
class Stopwatch {
 public:
  explicit Stopwatch(double& seconds) : seconds_(seconds) {}
  ~Stopwatch() { seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double& seconds_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

void require(bool condition, const std::string& name, double value, const std::string& wanted) {
  if (!condition) {
    throw std::invalid_argument("tracker settings: " + name + " is " + std::to_string(value) + ", but must be " +
                                wanted);
  }
}

TrackerSettings filled_in(TrackerSettings settings) {
  require(std::isfinite(settings.spacing) && settings.spacing > 0, "spacing", settings.spacing, "positive (m)");
  require(std::isfinite(settings.edge_length) && settings.edge_length >= 0, "edge_length", settings.edge_length,
          "positive (m), or 0 for 0.75 spacings");
  require(settings.max_motion > 0, "max_motion", settings.max_motion, "positive (effective radii)");
  require(settings.fairing_iterations >= 0, "fairing_iterations", settings.fairing_iterations, "0 or more");
  require(settings.fairing_stiffness >= 0 && settings.fairing_stiffness <= 1, "fairing_stiffness",
          settings.fairing_stiffness, "from 0 to 1");
  if (settings.field.radius == 0) settings.field = default_field_settings(settings.spacing);
  require(std::isfinite(settings.field.radius) && settings.field.radius > 0, "field.radius", settings.field.radius,
          "positive (m), or 0 for the default");
  require(settings.field.threshold > 0, "field.threshold", settings.field.threshold, "positive");
  require(settings.field.weight > 0, "field.weight", settings.field.weight, "positive");
  if (settings.edge_length == 0) settings.edge_length = kDefaultEdgeInSpacings * settings.spacing;
  return settings;
}

// What was tolerated, as far as it is still there.
MeshDefects at_most(const MeshDefects& a, const MeshDefects& b) {
  return {std::min(a.off_vertices, b.off_vertices), std::min(a.bad_triangles, b.bad_triangles),
          std::min(a.long_edges, b.long_edges), std::min(a.off_triangles, b.off_triangles)};
}

}  // namespace

class TrackerImpl {
 public:
  TrackerImpl(TrackerSettings settings, const Particles& particles)
      : settings_(filled_in(std::move(settings))), method_(make_velocity_method(settings_.velocity)) {
    check(particles);
    particles_ = particles;
    rebuild_field();
    if (field_) adopt(extract_raw());
    finish();
  }

  void advance(const Particles& particles) {
    check(particles);
    report_ = {};
    if (particles.positions.empty() || particles_.positions.empty() || mesh_.positions.empty()) {
      restart(particles);
    } else {
      advect(particles);
      Projection projection = fair_and_project();
      if (settings_.guard) guard(std::move(projection));
    }
    finish();
  }

  std::vector<Confidence> confidence() const {
    return field_ ? field_confidence(*field_, mesh_.positions) : std::vector<Confidence>(mesh_.positions.size());
  }
  const SurfaceMesh& mesh() const { return mesh_; }
  const TrackerReport& report() const { return report_; }
  const TrackerSettings& settings() const { return settings_; }

 private:
  void check(const Particles& particles) const {
    check_particles(particles);
    if (particles.velocities.empty() && !particles.positions.empty() && needs_particle_velocities(settings_.velocity)) {
      throw std::invalid_argument(
          "the velocity method \"" + settings_.velocity +
          "\" needs the particles' velocities, which are unknown here; choose a method that goes "
          "by the field alone, such as affine");
    }
  }

  void rebuild_field() {
    field_.reset();
    if (!particles_.positions.empty()) field_.emplace(field_of(particles_, settings_.field));
  }

  SurfaceGeometry extract_raw() const { return extract_raw_surface(*field_, settings_.edge_length); }

  GuardSettings guard_settings() const {
    return default_guard(settings_.spacing, settings_.edge_length, settings_.field);
  }

  // Makes the raw surface the tracked mesh; it takes its material from the old mesh and the particles.
  void adopt(const SurfaceGeometry& raw) {
    const SurfaceGeometry geometry = improve_surface(*field_, settings_.edge_length, raw);
    std::vector<Vec3> positions = geometry.positions;
    const Projection projection = project_to_surface(*field_, default_projection(settings_.field), positions);
    MaterialSettings material;
    material.reach = settings_.edge_length;
    material.same_vertex = settings_.edge_length / 3;
    material.far_reach = kFarReach * settings_.field.radius;
    mesh_ = carry_material(mesh_, geometry, projection.normals, *field_, particles_, material);
    topology_ = build_topology(static_cast<int>(mesh_.positions.size()), mesh_.triangles);
    rest_lengths_ = edge_lengths(topology_, mesh_.positions);
    tolerated_ = find_defects(*field_, mesh_.positions, mesh_.triangles, topology_, projection, guard_settings());
    velocities_known_ = false;
  }

  // There was no surface before, or there are no particles now.
  void restart(const Particles& particles) {
    Stopwatch watch(report_.seconds_guard);
    particles_ = particles;
    rebuild_field();
    const bool had_surface = !mesh_.positions.empty();
    const std::uint64_t next_id = mesh_.next_id;
    mesh_ = {};
    mesh_.next_id = next_id;
    if (field_) adopt(extract_raw());
    const bool has_surface = !mesh_.positions.empty();
    report_.reextracted = had_surface || has_surface;
    if (report_.reextracted) report_.reason = has_surface ? "a surface appeared" : "the surface vanished";
  }

  // Carries the vertices to the time of the new particles, in substeps.
  void advect(const Particles& particles) {
    const ParticlePaths paths(particles_, particles, kLongestJump * settings_.field.radius);
    report_.blended = paths.blended();
    report_.mismatch = paths.mismatch();
    const double limit = settings_.max_motion * settings_.field.radius;
    report_.substeps =
        static_cast<int>(std::clamp(std::ceil(paths.longest_path() / limit), 1.0, double{kMostSubsteps}));
    const double duration = paths.end_time() - paths.begin_time();
    const auto field_at = [&](double time) { return paths.field(time, settings_.field); };
    // The velocities of the last call hold at the start, unless particles come or go.
    std::vector<Vec3> first;
    if (paths.blended()) {
      if (duration != 0)
        field_.emplace(paths.field(paths.begin_time(), settings_.field));  // the same, but for its rates
    } else if (velocities_known_ && particles_.ids == particles.ids) {
      first = mesh_.velocities;
    }

    for (int substep = 0; substep < report_.substeps && duration != 0; ++substep) {
      const double time = paths.begin_time() + duration * substep / report_.substeps;
      const bool last = substep + 1 == report_.substeps;
      const double next = last ? paths.end_time() : paths.begin_time() + duration * (substep + 1) / report_.substeps;
      {
        Stopwatch watch(report_.seconds_velocity);
        advect_step(*method_, topology_, settings_.integrator, *field_, field_at, time, next - time, first,
                    mesh_.positions);
        first.clear();
        field_.emplace(field_at(next));
      }
      Stopwatch watch(report_.seconds_projection);
      project_to_surface(*field_, default_projection(settings_.field), mesh_.positions);
    }
    particles_ = particles;
    if (report_.substeps == 0 || duration == 0) rebuild_field();
  }

  Projection fair_and_project() {
    {
      Stopwatch watch(report_.seconds_fairing);
      std::vector<Confidence> confidence;
      if (settings_.variable_springs) confidence = field_confidence(*field_, mesh_.positions);
      fair(*field_, topology_, rest_lengths_, {settings_.fairing_iterations, settings_.fairing_stiffness}, confidence,
           mesh_.positions);
      if (settings_.remeshing) remesh_surface();
    }
    Projection projection;
    {
      Stopwatch watch(report_.seconds_projection);
      projection = project_to_surface(*field_, default_projection(settings_.field), mesh_.positions);
    }
    Stopwatch watch(report_.seconds_fairing);
    repair(*field_, default_projection(settings_.field), topology_, mesh_.triangles, mesh_.positions, projection);
    if (settings_.remeshing) untangle(projection);
    return projection;
  }

  // Where relaxing a tangle does not help, its edges are collapsed.
  void untangle(Projection& projection) {
    for (int round = 0; round < kUntanglingRounds; ++round) {
      const std::vector<int> bad = bad_triangles(mesh_.positions, mesh_.triangles, topology_, projection.normals);
      if (bad.empty()) return;
      const std::vector<std::uint64_t> old_ids = mesh_.ids;
      const int collapses = collapse_triangles(bad, projection.normals, 2 * settings_.edge_length, mesh_);
      if (collapses == 0) return;
      report_.collapses += collapses;
      update_topology(old_ids);
      projection = project_to_surface(*field_, default_projection(settings_.field), mesh_.positions);
      repair(*field_, default_projection(settings_.field), topology_, mesh_.triangles, mesh_.positions, projection);
    }
  }

  // After a change of the triangles; the springs of edges that stay keep their rest lengths.
  void update_topology(const std::vector<std::uint64_t>& old_ids) {
    const MeshTopology old_topology =
        std::exchange(topology_, build_topology(static_cast<int>(mesh_.positions.size()), mesh_.triangles));
    rest_lengths_ = carry_rest_lengths(old_ids, old_topology, rest_lengths_, mesh_, topology_, settings_.edge_length);
  }

  // Brings edges near their target length.
  void remesh_surface() {
    const std::vector<std::uint64_t> old_ids = mesh_.ids;
    RemeshSettings limits;
    limits.edge_length = settings_.edge_length;
    const RemeshReport done = remesh(*field_, limits, mesh_);
    report_.splits = done.splits;
    report_.collapses = done.collapses;
    report_.flips = done.flips;
    if (done.changed()) update_topology(old_ids);
  }

  // A small part that is spoilt is no reason to replace the whole mesh.
  void drop_parts(Projection& projection) {
    const std::vector<std::uint64_t> old_ids = mesh_.ids;
    const std::vector<int> bad = bad_triangles(mesh_.positions, mesh_.triangles, topology_, projection.normals);
    if (!drop_spoilt_parts(projection, bad, guard_settings().small_volume, mesh_)) return;
    update_topology(old_ids);
    projection = project_to_surface(*field_, default_projection(settings_.field), mesh_.positions);
  }

  // Replaces a mesh that does not fit the field any more.
  void guard(Projection projection) {
    Stopwatch watch(report_.seconds_guard);
    drop_parts(projection);
    const SurfaceGeometry raw = extract_raw();
    const MeshDefects defects =
        find_defects(*field_, mesh_.positions, mesh_.triangles, topology_, projection, guard_settings());
    const GuardVerdict verdict = inspect(raw, mesh_.positions, mesh_.triangles, defects, tolerated_, guard_settings());
    report_.expected_components = verdict.expected_components;
    report_.expected_volume = verdict.expected_volume;
    if (verdict.reasons.empty()) {
      tolerated_ = at_most(tolerated_, defects);
      return;
    }
    report_.reextracted = true;
    for (const std::string& reason : verdict.reasons) {
      report_.reason += (report_.reason.empty() ? "" : "; ") + reason;
    }
    adopt(raw);
  }

  // Velocities at the vertices, and the measures of the mesh as it is now.
  void finish() {
    velocities_known_ = true;
    if (field_ && !mesh_.positions.empty()) {
      Stopwatch watch(report_.seconds_velocity);
      method_->evaluate(*field_, topology_, mesh_.positions, mesh_.velocities);
    }
    const MeshComponents components = mesh_components(mesh_.positions, mesh_.triangles);
    report_.components = components.count;
    report_.volume = mesh_volume(mesh_.positions, mesh_.triangles);
    report_.area = mesh_area(mesh_.positions, mesh_.triangles);
    report_.max_distance = largest_distance();
    // Without a comparison of its own, the mesh is a fresh extraction itself.
    if (report_.expected_components == 0) {
      report_.expected_components = report_.components;
      report_.expected_volume = report_.volume;
    }
  }

  double largest_distance() const {
    double largest = 0;
#pragma omp parallel for reduction(max : largest) schedule(static)
    for (int v = 0; v < static_cast<int>(mesh_.positions.size()); ++v) {
      largest = std::max(largest, surface_distance(*field_, mesh_.positions[v]).distance);
    }
    return largest;
  }

  TrackerSettings settings_;
  std::unique_ptr<VelocityMethod> method_;
  Particles particles_;                 // of the last call
  std::optional<MetaballField> field_;  // of these particles; none where there are none
  SurfaceMesh mesh_;
  MeshTopology topology_;
  std::vector<double> rest_lengths_;  // of the springs [FMM13, 3.4], one an edge
  MeshDefects tolerated_;             // since the mesh was extracted
  bool velocities_known_ = false;     // mesh_.velocities are the method's, at the time of particles_
  TrackerReport report_;
};

Tracker::Tracker(TrackerSettings settings, const Particles& particles)
    : impl_(std::make_unique<TrackerImpl>(std::move(settings), particles)) {}
Tracker::~Tracker() = default;
Tracker::Tracker(Tracker&&) noexcept = default;
Tracker& Tracker::operator=(Tracker&&) noexcept = default;

void Tracker::advance(const Particles& particles) { impl_->advance(particles); }
std::vector<Confidence> Tracker::confidence() const { return impl_->confidence(); }
const SurfaceMesh& Tracker::mesh() const { return impl_->mesh(); }
const TrackerReport& Tracker::report() const { return impl_->report(); }
const TrackerSettings& Tracker::settings() const { return impl_->settings(); }

}  // namespace flowskin::tracking
