#include "surfaces/surface_checks.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <unordered_set>

#include "common/closest_point.h"
#include "common/quantile.h"
#include "scenes/scene_file.h"
#include "scenes/sources/make_source.h"
#include "surfaces/dense_distance.h"
#include "tools/pipeline/tracker_bridge.h"
#include "tracking/advection/particle_paths.h"
#include "tracking/advection/projection.h"
#include "tracking/extraction/extract_surface.h"
#include "tracking/ground_truth/surface_comparison.h"
#include "tracking/material/material.h"
#include "tracking/mesh/mesh_check.h"
#include "tracking/mesh/mesh_measures.h"
#include "tracking/mesh/self_intersections.h"

namespace flowskin::surfaces {
namespace {

using tracking::MetaballField;
using tracking::SurfaceMesh;
using tracking::Triangle;
using tracking::Vec3;

template <class Work>
auto timed(double& seconds, Work work) {
  const auto start = std::chrono::steady_clock::now();
  auto result = work();
  seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

Shape shape_of(const tracking::SurfaceShape& all) {
  return {all.components - all.small_components, all.euler - all.small_euler, all.small_components, all.small_euler};
}

/// Share of values for which it holds.
template <class Values, class Condition>
double share_of(const Values& values, Condition holds) {
  if (values.empty()) return 0;
  return static_cast<double>(std::count_if(values.begin(), values.end(), holds)) / static_cast<double>(values.size());
}

/// Runs one scene; `measure` looks at the present state.
class Run {
 public:
  explicit Run(const std::filesystem::path& file)
      : scene_(scenes::read_scene(file)), source_(scenes::make_source(scene_)) {
    scene_.tracking.velocity = scenes::velocity_method_for(scene_.tracking.velocity, source_->state());
    result_.name = scene_.name;
    tracker_.emplace(timed(result_.seconds_tracking,
                           [&] { return tracking::Tracker(scenes::settings_in_metres(scene_), particles()); }));
    result_.spacing = scene_.particles.spacing;
    result_.edge_length = tracker_->settings().edge_length;
    first_ = tracker_->mesh();
  }

  SceneMeasures run(int most_frames, const std::function<void(const SceneMeasures&)>& after_frame) {
    const int frames = most_frames > 0 ? std::min(most_frames, scene_.frames) : scene_.frames;
    for (int frame = 0; frame <= frames; ++frame) {
      FrameMeasures measures;
      measures.frame = frame;
      if (frame > 0) advance(frame, measures);
      timed(result_.seconds_checks, [&] { return measure(measures), 0; });
      result_.frames.push_back(std::move(measures));
      if (after_frame) after_frame(result_);
    }
    if (is_back()) result_.round_trip = round_trip();
    return std::move(result_);
  }

 private:
  tracking::Particles particles() const { return tools::to_particles(source_->state()); }

  void advance(int frame, FrameMeasures& measures) {
    for (int step = 1; step <= scene_.tracking.steps_per_frame; ++step) {
      const double time = (frame - 1 + double(step) / scene_.tracking.steps_per_frame) / scene_.frame_rate;
      timed(result_.seconds_source, [&] { return source_->advance_to(time), 0; });
      timed(result_.seconds_tracking, [&] { return tracker_->advance(particles()), 0; });
      measures.regions += tracker_->report().regions;
      measures.born += tracker_->report().born;
      if (!tracker_->report().reextracted) continue;
      ++measures.reextractions;
      measures.reason = tracker_->report().reason;
    }
  }

  void measure(FrameMeasures& measures) {
    const SurfaceMesh& mesh = tracker_->mesh();
    const tracking::Particles now = particles();
    const tracking::FieldSettings& field_settings = tracker_->settings().field;
    measures.particles = now.positions.size();
    measures.vertices = mesh.positions.size();
    measures.problems = tracking::mesh_problems(mesh);
    measures.volume = tracking::mesh_volume(mesh.positions, mesh.triangles);
    const double area = tracking::mesh_area(mesh.positions, mesh.triangles);
    if (area_before_ > 0) measures.area_lost = std::max(0.0, 1 - area / area_before_);
    area_before_ = area;
    measure_triangles(mesh, measures);
    if (!now.positions.empty()) {
      const MetaballField field = tracking::field_of(now, field_settings);
      const tracking::SurfaceGeometry fresh = tracking::extract_raw_surface(field, result_.edge_length);
      compare(mesh, fresh, measures);
      if (measures.volume_error > limit::volume) compare_with_finer(field, fresh, measures);
      measures.field_distance = tracking::largest_distance(field, mesh.positions) / field_settings.radius;
      if (!now.rest_positions.empty()) {
        measures.material_drift = quantile(tracking::material_drift(mesh, field, now), 0.5) / result_.spacing;
        measures.material_scatter = quantile(tracking::material_scatter(field, now), 0.5) / result_.spacing;
      }
    }
    measure_ids(mesh, measures);
  }

  void measure_triangles(const SurfaceMesh& mesh, FrameMeasures& measures) const {
    const auto angles = tracking::smallest_angles(mesh.positions, mesh.triangles);
    measures.narrow_triangles = 1 - tracking::share_of_angles_above(angles, limit::smallest_angle);
    const double edge = result_.edge_length;
    measures.odd_edges = 1 - tracking::share_of_edges_within(mesh.positions, mesh.triangles,
                                                             limit::shortest_edge * edge, limit::longest_edge * edge);
    measures.self_intersections = tracking::self_intersections(mesh.positions, mesh.triangles).size();
  }

  void compare(const SurfaceMesh& mesh, const tracking::SurfaceGeometry& fresh, FrameMeasures& measures) const {
    const double edge = result_.edge_length, small_volume = limit::small_component * std::pow(edge, 3);
    const tracking::SurfaceComparison comparison =
        tracking::compare_surfaces(mesh.positions, mesh.triangles, fresh, small_volume);
    measures.shape = shape_of(comparison.mesh);
    measures.fresh_shape = shape_of(comparison.fresh);
    measures.borderline = !measures.shape.same_topology(measures.fresh_shape) && comparison.same_topology();
    measures.volume_error = std::abs(comparison.volume_error());
    measures.hausdorff_at_corners = comparison.hausdorff / edge;
    measures.hausdorff = dense_hausdorff({mesh.positions, mesh.triangles}, fresh, small_volume) / edge;
  }

  /// Which of the two encloses what the field does.
  void compare_with_finer(const MetaballField& field, const tracking::SurfaceGeometry& fresh,
                          FrameMeasures& measures) const {
    const auto finer = tracking::extract_raw_surface(field, result_.edge_length / 3);
    const double volume = tracking::mesh_volume(finer.positions, finer.triangles);
    measures.true_volume_error = measures.volume / volume - 1;
    measures.fresh_true_volume_error = tracking::mesh_volume(fresh.positions, fresh.triangles) / volume - 1;
  }

  void measure_ids(const SurfaceMesh& mesh, FrameMeasures& measures) {
    const std::unordered_set<std::uint64_t> ids(mesh.ids.begin(), mesh.ids.end());
    if (measures.frame > 0) {
      measures.change = !measures.fresh_shape.all_the_same(result_.frames.back().fresh_shape);
      if (!ids_before_.empty())
        measures.ids_kept = share_of(ids_before_, [&](std::uint64_t id) { return ids.count(id) > 0; });
    }
    ids_before_ = mesh.ids;
  }

  /// Whether every particle is where it was at the start, after a way.
  bool is_back() const {
    const scenes::ParticleState& state = source_->state();
    if (scene_.particles.source != scenes::ParticlesSpec::Source::prescribed || state.time == 0) return false;
    for (std::size_t i = 0; i < state.positions.size(); ++i) {
      if ((state.positions[i] - state.rest_positions[i]).norm() > 1e-3 * result_.spacing) return false;
    }
    return true;
  }

  ReturnMeasures round_trip() const {
    const SurfaceMesh& last = tracker_->mesh();
    const ClosestPointTree tree(first_.positions, first_.triangles);
    std::vector<double> distances, texture;
    ReturnMeasures result;
    for (std::size_t v = 0; v < last.positions.size(); ++v) {
      distances.push_back(tree.closest(last.positions[v], 1e3).distance);
      texture.push_back((last.rest_positions[v] - last.positions[v]).norm());
      result.mean_distance += distances.back() / static_cast<double>(last.positions.size());
    }
    result.largest_distance = quantile(distances, 1);
    result.median_texture_error = quantile(texture, 0.5);
    result.texture_error_99 = quantile(texture, 0.99);
    result.volume_change = result_.frames.back().volume / result_.frames.front().volume - 1;
    return result;
  }

  scenes::Scene scene_;
  std::unique_ptr<scenes::ParticleSource> source_;
  std::optional<tracking::Tracker> tracker_;
  SurfaceMesh first_;
  std::vector<std::uint64_t> ids_before_;
  double area_before_ = 0;
  SceneMeasures result_;
};

}  // namespace

SceneMeasures measure_scene(const std::filesystem::path& scene_file, int most_frames,
                            const std::function<void(const SceneMeasures&)>& after_frame) {
  return Run(scene_file).run(most_frames, after_frame);
}

}  // namespace flowskin::surfaces
