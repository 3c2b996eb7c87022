#include "tools/pipeline/frame_statistics.h"

#include <algorithm>
#include <numbers>
#include <utility>

#include "tools/pipeline/tracker_bridge.h"
#include "tracking/ground_truth/quantile.h"
#include "tracking/mesh/mesh_measures.h"
#include "tracking/mesh/texture_stretch.h"
#include "tracking/topology/material.h"

namespace flowskin::tools {

namespace {

using tracking::quantile;

void describe_surface(const tracking::SurfaceMesh& mesh, FrameRow& row) {
  row.vertices = mesh.positions.size();
  row.triangles = mesh.triangles.size();
  row.euler = tracking::euler_characteristic(mesh.positions, mesh.triangles);
  row.smallest_angle = tracking::mesh_quality(mesh.positions, mesh.triangles).smallest_angle * 180 / std::numbers::pi;
  std::vector<double> stretch;
  for (const auto& triangle : tracking::texture_stretch(mesh)) stretch.push_back(triangle.largest);
  row.stretch_median = quantile(stretch, 0.5);
  row.stretch_p99 = quantile(stretch, 0.99);
}

void describe_source(const scenes::ParticleSource& source, FrameRow& row) {
  const scenes::SourceStatistics statistics = source.statistics();
  row.particles = source.state().positions.size();
  row.kinetic_energy = statistics.kinetic_energy;
  row.potential_energy = statistics.potential_energy;
  row.steps = statistics.steps;
  row.time_step = statistics.last_time_step;
  row.mean_density_error = statistics.mean_density_error;
  row.max_density_error = statistics.max_density_error;
  row.left_domain = statistics.left_domain;
  row.wall_crossings = statistics.wall_crossings;
}

int count_common(const std::vector<std::uint64_t>& a, const std::vector<std::uint64_t>& b) {
  int common = 0;
  for (auto i = a.begin(), j = b.begin(); i != a.end() && j != b.end();) {
    common += *i == *j;
    const bool step_i = *i <= *j, step_j = *j <= *i;
    i += step_i;
    j += step_j;
  }
  return common;
}

}  // namespace

void FrameStatistics::add(const tracking::TrackerReport& report) {
  substeps_ += report.substeps;
  splits_ += report.splits;
  collapses_ += report.collapses;
  flips_ += report.flips;
  seconds_guard_ += report.seconds_guard;
  if (!report.reextracted) return;
  ++reextractions_;
  last_reason_ = report.reason;
}

FrameRow FrameStatistics::finish_frame(int frame, const scenes::ParticleSource& source,
                                       const tracking::Tracker* tracker, const SurfaceFrame* surface) {
  FrameRow row;
  row.frame = frame;
  row.time = source.state().time;
  describe_source(source, row);
  if (tracker && surface) {
    const tracking::TrackerReport& report = tracker->report();
    row.components = report.components;
    row.volume = report.volume;
    row.expected_volume = report.expected_volume;
    row.area = report.area;
    row.max_distance = report.max_distance;
    describe_surface(surface->mesh, row);
    if (row.vertices > 0 && row.particles > 0 && source.state().has_material) {
      const tracking::Particles particles = to_particles(source.state());
      const tracking::MetaballField field(particles.positions, {}, tracker->settings().field);
      row.texture_drift = quantile(tracking::material_drift(surface->mesh, field, particles), 0.5);
    }
    std::vector<std::uint64_t> ids = surface->mesh.ids;
    std::sort(ids.begin(), ids.end());
    row.kept_ids = count_common(ids, previous_ids_);
    previous_ids_ = std::move(ids);
  }
  row.substeps = substeps_;
  row.splits = std::exchange(splits_, 0);
  row.collapses = std::exchange(collapses_, 0);
  row.flips = std::exchange(flips_, 0);
  row.reextractions = reextractions_;
  row.seconds_guard = std::exchange(seconds_guard_, 0);
  frames_reextracted_ += reextractions_ > 0;
  substeps_ = reextractions_ = 0;
  return row;
}

}  // namespace flowskin::tools
