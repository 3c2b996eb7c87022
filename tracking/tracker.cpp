#include "tracking/tracker.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "common/bounds.h"
#include "common/number_text.h"
#include "common/stopwatch.h"
#include "tracking/advection/particle_motion.h"
#include "tracking/advection/particle_paths.h"
#include "tracking/advection/projection.h"
#include "tracking/extraction/extract_surface.h"
#include "tracking/fairing/fairing.h"
#include "tracking/fairing/repair.h"
#include "tracking/material/material.h"
#include "tracking/material/surface_material.h"
#include "tracking/mesh/adjacency.h"
#include "tracking/mesh/mesh_check.h"
#include "tracking/mesh/mesh_measures.h"
#include "tracking/remeshing/remesh.h"
#include "tracking/repair/change_topology.h"
#include "tracking/repair/repair_limits.h"

namespace flowskin::tracking {
namespace {

constexpr double kDefaultEdgeInSpacings = 0.75;
constexpr int kMostSubsteps = 1000;
constexpr int kRemeshingPasses = 3;
constexpr double kTornAtRest =
    3;                      // times its length: the ends of an edge that were farther apart at rest are of two bodies
constexpr int kFewIn = 50;  // one operation in so many vertices is few: another pass is not worth it
constexpr double kFarReach = 2;  // of old material where particles know none, in effective radii

void require(bool condition, const std::string& name, double value, const std::string& wanted) {
  if (!condition) {
    throw std::invalid_argument("tracker settings: " + name + " is " + number_text(value, 4) + ", but must be " +
                                wanted);
  }
}

void check_lengths(const TrackerSettings& settings) {
  require(std::isfinite(settings.spacing) && settings.spacing > 0, "spacing", settings.spacing, "positive (m)");
  require(std::isfinite(settings.edge_length) && settings.edge_length >= 0, "edge_length", settings.edge_length,
          "positive (m), or 0 for 0.75 spacings");
}

void check_rest(const TrackerSettings& settings) {
  require(settings.max_motion > 0, "max_motion", settings.max_motion, "positive (effective radii)");
  require(settings.fairing_iterations >= 0, "fairing_iterations", settings.fairing_iterations, "0 or more");
  require(std::isfinite(settings.curvature_edges) && settings.curvature_edges >= 0, "curvature_edges",
          settings.curvature_edges, "positive (radii of curvature), or 0 for edges that are all alike");
  require(std::isfinite(settings.smallest_part) && settings.smallest_part >= 0, "smallest_part", settings.smallest_part,
          "positive (m^3), or 0 for none");
  require(std::isfinite(settings.max_slip) && settings.max_slip >= 0, "max_slip", settings.max_slip,
          "positive (m), or 0 for no limit");
  require(settings.fairing_stiffness >= 0 && settings.fairing_stiffness <= 1, "fairing_stiffness",
          settings.fairing_stiffness, "from 0 to 1");
}

// For a field that is not made of particles.
TrackerSettings filled_in_for_field(TrackerSettings settings) {
  if (settings.spacing == 0) settings.spacing = settings.edge_length / kDefaultEdgeInSpacings;
  check_lengths(settings);
  check_rest(settings);
  if (settings.edge_length == 0) settings.edge_length = kDefaultEdgeInSpacings * settings.spacing;
  return settings;
}

TrackerSettings filled_in(TrackerSettings settings) {
  check_lengths(settings);
  check_rest(settings);
  if (settings.field.radius == 0) {
    const double wall_share = settings.field.wall_share;
    settings.field = default_field_settings(settings.spacing);
    settings.field.wall_share = wall_share;
  }
  require(std::isfinite(settings.field.radius) && settings.field.radius > 0, "field.radius", settings.field.radius,
          "positive (m), or 0 for the default");
  require(settings.field.wall_share >= 0 && settings.field.wall_share <= 0.5, "field.wall_share",
          settings.field.wall_share, "from 0 to 0.5 (thresholds)");
  require(settings.field.threshold > 0, "field.threshold", settings.field.threshold, "positive");
  require(settings.field.weight > 0, "field.weight", settings.field.weight, "positive");
  if (settings.edge_length == 0) settings.edge_length = kDefaultEdgeInSpacings * settings.spacing;
  return settings;
}

}  // namespace

class TrackerImpl {
 public:
  TrackerImpl(TrackerSettings settings, const Particles& particles)
      : settings_(filled_in(std::move(settings))),
        method_(make_velocity_method(settings_.velocity)),
        scale_(settings_.field.scale()) {
    check(particles);
    particles_ = particles;
    rebuild_field();
    if (field_) adopt(extract_raw());
    finish();
  }

  TrackerImpl(TrackerSettings settings, std::shared_ptr<const ImplicitField> field, double time)
      : settings_(filled_in_for_field(std::move(settings))),
        method_(make_velocity_method(settings_.velocity)),
        scale_(field->scale()),
        follows_particles_(false) {
    if (needs_particle_velocities(settings_.velocity)) {
      throw std::invalid_argument("the velocity method \"" + settings_.velocity +
                                  "\" needs particles, and this field is not made of any; choose a method that goes by "
                                  "the field alone, such as affine");
    }
    particles_.time = time;
    field_ = std::move(field);
    adopt(extract_raw());
    finish();
  }

  void advance(const FieldMotion& motion) {
    if (follows_particles_) throw std::invalid_argument("the tracker follows particles; a field alone has none");
    if (motion.begin_time() != particles_.time) {
      throw std::invalid_argument("the field's motion begins at " + number_text(motion.begin_time()) +
                                  " s, but the tracked surface is at " + number_text(particles_.time) + " s");
    }
    report_ = {};
    if (mesh_.positions.empty()) {
      field_ = motion.field(motion.end_time());
      restart();
    } else {
      if (motion.end_time() != motion.begin_time()) field_ = motion.field(motion.begin_time());
      advect(motion, {});
      if (!near_) near_.emplace(*field_, mesh_.positions, usual_slack(scale_));
      fit_to_field();
    }
    particles_.time = motion.end_time();
    finish();
  }

  void advance(const Particles& particles) {
    if (!follows_particles_) throw std::invalid_argument("the tracker follows a field that is not made of particles");
    check(particles);
    report_ = {};
    field_of_particles_ = true;
    if (particles.positions.empty() || particles_.positions.empty() || mesh_.positions.empty()) {
      particles_ = particles;
      rebuild_field();
      restart();
    } else {
      advect(particles);
      if (is_astray()) {
        near_.reset();
        restart();
        report_.reextracted = true;
        report_.reason = "the surface left the fluid";
      } else {
        fit_to_field();
      }
    }
    finish();
    // Where states are blended, so are the rates of the field at the end. From here on it is a function of the
    // particles alone: a saved state need not hold it.
    if (!field_of_particles_) rebuild_field();
  }

  const TrackerState& state() const { return state_; }
  void restore(TrackerState state) {
    check(state.particles);
    check_mesh(state.mesh);
    state.particles.walls = particles_.walls;
    state_ = std::move(state);
    rebuild_field();
    topology_ = build_adjacency(static_cast<int>(mesh_.positions.size()), mesh_.triangles);
    if (!mesh_.positions.empty() && rest_lengths_.size() != topology_.edges.size())
      throw std::invalid_argument("the state of the tracker has another number of springs than of edges");
    if (velocities_known_ && mesh_.velocities.size() != mesh_.positions.size())
      throw std::invalid_argument("the state of the tracker has other velocities than it says");
  }

  void begin_layer() { mesh_.layers.push_back(mesh_.positions); }

  void drop_layer(std::size_t layer) {
    if (layer >= mesh_.layers.size())
      throw std::out_of_range("the tracked mesh has " + std::to_string(mesh_.layers.size()) + " layer(s), not one " +
                              std::to_string(layer));
    mesh_.layers.erase(mesh_.layers.begin() + static_cast<std::ptrdiff_t>(layer));
  }

  std::vector<Confidence> confidence() const {
    return field_ ? field_confidence(*field_, mesh_.positions) : std::vector<Confidence>(mesh_.positions.size());
  }
  const SurfaceMesh& mesh() const { return mesh_; }
  std::shared_ptr<const ImplicitField> field() const { return field_; }
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

  static void check_mesh(const SurfaceMesh& mesh) {
    const std::size_t count = mesh.positions.size();
    bool sound = mesh.rest_positions.size() == count && mesh.ids.size() == count &&
                 (mesh.velocities.size() == count || mesh.velocities.empty());
    for (const auto& layer : mesh.layers) sound = sound && layer.size() == count;
    const auto finite = [](const std::vector<Vec3>& vectors) {
      return std::all_of(vectors.begin(), vectors.end(), [](const Vec3& v) { return v.allFinite(); });
    };
    sound = sound && finite(mesh.positions) && finite(mesh.rest_positions) && finite(mesh.velocities) &&
            std::all_of(mesh.layers.begin(), mesh.layers.end(), finite) &&
            connection_problems(static_cast<int>(count), mesh.triangles).empty();
    if (!sound) throw std::invalid_argument("the state of the tracker has a mesh that contradicts itself");
  }

  void rebuild_field() {
    if (!follows_particles_) return;
    field_.reset();
    if (!particles_.positions.empty())
      field_ = std::make_shared<const MetaballField>(field_of(particles_, settings_.field));
  }

  SurfaceGeometry extract_raw() const { return extract_raw_surface(*field_, settings_.edge_length); }

  MaterialSettings material_settings() const {
    MaterialSettings material;
    material.reach = settings_.edge_length;
    material.same_vertex = kRepairLimits.same_id * settings_.edge_length;
    material.far_reach = kFarReach * scale_.length;
    return material;
  }

  // Makes the raw surface the tracked mesh; it takes its material from the old mesh and the particles.
  Projection adopt(const SurfaceGeometry& raw) {
    SurfaceGeometry geometry = improve_surface(*field_, settings_.edge_length, raw);
    if (settings_.remeshing) geometry = settled(*field_, remesh_settings(), std::move(geometry));
    std::vector<Vec3> positions = geometry.positions;
    Projection projection = project_to_surface(*field_, default_projection(scale_), positions);
    mesh_ = carry_material(mesh_, geometry, projection.normals, *field_, particles_, material_settings());
    topology_ = build_adjacency(static_cast<int>(mesh_.positions.size()), mesh_.triangles);
    rest_lengths_ = edge_lengths(topology_, mesh_.positions);
    velocities_known_ = false;
    report_.max_distance = projection.max_distance = largest_distance(*field_, mesh_.positions);
    return projection;
  }

  // Whether a vertex has gone far away from all particles, where absurd velocities carried it: what is looked for along
  // its triangles would fill the memory.
  bool is_astray() const {
    const Box fluid = bounds(particles_.positions);
    const double farthest = (fluid.max - fluid.min).norm() + 100 * settings_.field.radius;
    return !std::all_of(mesh_.positions.begin(), mesh_.positions.end(),
                        [&](const Vec3& x) { return fluid.squared_distance(x) <= farthest * farthest; });
  }

  // There was no surface before, or there is no field now.
  void restart() {
    Stopwatch watch(report_.seconds_topology);
    const bool had_surface = !mesh_.positions.empty();
    SurfaceMesh empty;
    empty.next_id = mesh_.next_id;
    empty.layers.resize(mesh_.layers.size());
    mesh_ = std::move(empty);
    if (field_) adopt(extract_raw());
    const bool has_surface = !mesh_.positions.empty();
    if (had_surface != has_surface) report_.reason = has_surface ? "a surface appeared" : "the surface vanished";
  }

  // Carries the vertices to the time of the new particles.
  void advect(const Particles& particles) {
    const ParticlePaths paths(particles_, particles, settings_.spacing);
    report_.blended = paths.blended();
    report_.mismatch = paths.mismatch();
    field_of_particles_ = !paths.blended();
    const ParticleMotion motion(paths, settings_.field);
    // The velocities of the last call hold at the start, unless particles come or go.
    std::vector<Vec3> first;
    if (paths.blended()) {
      if (paths.end_time() != paths.begin_time())
        field_ = motion.field(paths.begin_time());  // the same, but for its rates
    } else if (velocities_known_ && particles_.ids == particles.ids && !paths.jumps()) {
      first = mesh_.velocities;
    }
    advect(motion, std::move(first));
    particles_ = particles;
    if (paths.end_time() != paths.begin_time()) return;
    rebuild_field();
    near_.emplace(*field_, mesh_.positions, usual_slack(scale_));
  }

  // Carries the vertices along with the field, in substeps.
  // @param first velocities at the beginning, where they are known
  void advect(const FieldMotion& motion, std::vector<Vec3> first) {
    const double limit = settings_.max_motion * scale_.length;
    report_.substeps =
        static_cast<int>(std::clamp(std::ceil(motion.longest_path() / limit), 1.0, double{kMostSubsteps}));
    const double duration = motion.end_time() - motion.begin_time();
    const auto field_at = [&motion](double time) { return motion.field(time); };
    for (int substep = 0; substep < report_.substeps && duration != 0; ++substep) {
      const double time = motion.begin_time() + duration * substep / report_.substeps;
      const bool last = substep + 1 == report_.substeps;
      const double next = last ? motion.end_time() : motion.begin_time() + duration * (substep + 1) / report_.substeps;
      {
        Stopwatch watch(report_.seconds_velocity);
        advect_step(*method_, topology_, settings_.integrator, *field_, field_at, time, next - time, first,
                    mesh_.positions);
        first.clear();
        field_ = motion.field(next);
      }
      Stopwatch watch(report_.seconds_projection);
      near_.emplace(*field_, mesh_.positions, usual_slack(scale_));
      project_to_surface(*near_, default_projection(scale_), mesh_.positions);
    }
  }

  // Makes the mesh that has been carried to the present field a good one of its surface.
  void fit_to_field() {
    Projection projection = fair_and_project();
    near_.reset();
    follow_topology(projection);
    report_.max_distance = projection.max_distance;
    if (settings_.max_slip > 0 && !particles_.rest_positions.empty()) {
      Stopwatch watch(report_.seconds_topology);
      report_.held_back = limit_slip(settings_.max_slip, *field_->particles(), particles_, mesh_);
    }
  }

  Projection fair_and_project() {
    {
      Stopwatch watch(report_.seconds_fairing);
      std::vector<Confidence> confidence;
      if (settings_.variable_springs) confidence = field_confidence(*field_, mesh_.positions);
      slide([&] {
        fair(*near_, topology_, rest_lengths_, {settings_.fairing_iterations, settings_.fairing_stiffness}, confidence,
             mesh_.positions);
      });
      if (settings_.remeshing) remesh_surface();
    }
    Projection projection;
    {
      Stopwatch watch(report_.seconds_projection);
      projection = project_to_surface(*field_, default_projection(scale_), mesh_.positions);
    }
    Stopwatch watch(report_.seconds_fairing);
    slide(
        [&] { repair(*field_, default_projection(scale_), topology_, mesh_.triangles, mesh_.positions, projection); });
    return projection;
  }

  // The material stays where it is while vertices move along the surface.
  template <class Move>
  void slide(const Move& move) {
    if (settings_.fairing_drags) return move();
    const std::vector<Vec3> before = mesh_.positions;
    move();
    take_material_of_new_places(before, topology_, mesh_);
  }

  // After a change of the triangles; the springs of edges that stay keep their rest lengths.
  void update_topology(const std::vector<std::uint64_t>& old_ids) {
    const MeshAdjacency old_topology =
        std::exchange(topology_, build_adjacency(static_cast<int>(mesh_.positions.size()), mesh_.triangles));
    rest_lengths_ = carry_rest_lengths(old_ids, old_topology, rest_lengths_, mesh_, topology_, settings_.edge_length);
  }

  RemeshSettings remesh_settings() const {
    RemeshSettings limits;
    limits.edge_length = settings_.edge_length;
    limits.curvature = settings_.curvature_edges;
    limits.torn = kTornAtRest;
    return limits;
  }

  // Brings edges near their target length.
  void remesh_surface() {
    const std::vector<std::uint64_t> old_ids = mesh_.ids;
    const RemeshSettings limits = remesh_settings();
    const auto few = static_cast<int>(mesh_.positions.size()) / kFewIn;
    for (int pass = 0; pass < kRemeshingPasses; ++pass) {
      const RemeshReport done = remesh(*field_, limits, mesh_);
      report_.splits += done.splits;
      report_.collapses += done.collapses;
      report_.flips += done.flips;
      if (done.splits + done.collapses + done.flips <= few) break;
    }
    if (report_.splits + report_.collapses + report_.flips > 0) update_topology(old_ids);
  }

  // Follows merging, splitting, appearing and vanishing: replaces the regions where mesh and field disagree; and the
  // whole mesh, as a last resort, where that does not work.
  void follow_topology(Projection& projection) {
    if (!settings_.topology && !settings_.guard) return;
    Stopwatch watch(report_.seconds_topology);
    const TopologyReport done = change_regions(projection);
    report_.regions = done.regions;
    report_.born = done.born;
    report_.balls = done.balls;
    tolerated_ = std::min(tolerated_, done.stubborn);
    if (!settings_.guard || done.stubborn <= tolerated_) return;
    report_.reextracted = true;
    report_.reason = std::to_string(done.stubborn) + " region(s): " + done.why;
    projection = adopt(extract_raw());
    // What a fresh mesh does not get right either is let pass as long as it is there.
    tolerated_ = change_regions(projection).stubborn;
  }

  TopologyReport change_regions(Projection& projection) {
    const std::vector<std::uint64_t> old_ids = mesh_.ids;
    TopologySettings limits;
    limits.edge_length = settings_.edge_length;
    limits.depth = kRepairLimits.wrong_side_depth * settings_.edge_length;
    limits.local = settings_.topology;
    limits.smallest_part = settings_.smallest_part;
    limits.small_parts = settings_.small_parts;
    limits.material = material_settings();
    const TopologyReport done = change_topology(*field_, particles_, limits, mesh_, projection);
    if (done.changed()) update_topology(old_ids);
    return done;
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
  }

  TrackerSettings settings_;
  std::unique_ptr<VelocityMethod> method_;
  FieldScale scale_;
  bool follows_particles_ = true;  // else a field that is not made of any
  TrackerState state_;
  Particles& particles_ = state_.particles;
  SurfaceMesh& mesh_ = state_.mesh;
  std::vector<double>& rest_lengths_ = state_.rest_lengths;
  int& tolerated_ = state_.tolerated;
  bool& velocities_known_ = state_.velocities_known;
  TrackerReport& report_ = state_.report;
  // What follows from the state.
  std::shared_ptr<const ImplicitField> field_;  // at present; none where there are no particles
  MeshAdjacency topology_;
  std::optional<Neighborhoods> near_;  // during a step: of places near the vertices before fairing
  bool field_of_particles_ = true;     // false during a step: the field is a blend of two states
};

Tracker::Tracker(TrackerSettings settings, const Particles& particles)
    : impl_(std::make_unique<TrackerImpl>(std::move(settings), particles)) {}
Tracker::Tracker(TrackerSettings settings, std::shared_ptr<const ImplicitField> field, double time)
    : impl_(std::make_unique<TrackerImpl>(std::move(settings), std::move(field), time)) {}
Tracker::~Tracker() = default;
Tracker::Tracker(Tracker&&) noexcept = default;
Tracker& Tracker::operator=(Tracker&&) noexcept = default;

void Tracker::advance(const Particles& particles) { impl_->advance(particles); }
void Tracker::advance(const FieldMotion& motion) { impl_->advance(motion); }
void Tracker::begin_layer() { impl_->begin_layer(); }
void Tracker::drop_layer(std::size_t layer) { impl_->drop_layer(layer); }
std::vector<Confidence> Tracker::confidence() const { return impl_->confidence(); }
const SurfaceMesh& Tracker::mesh() const { return impl_->mesh(); }
std::shared_ptr<const ImplicitField> Tracker::field() const { return impl_->field(); }
const TrackerReport& Tracker::report() const { return impl_->report(); }
const TrackerSettings& Tracker::settings() const { return impl_->settings(); }
const TrackerState& Tracker::state() const { return impl_->state(); }
void Tracker::restore(TrackerState state) { impl_->restore(std::move(state)); }

}  // namespace flowskin::tracking
