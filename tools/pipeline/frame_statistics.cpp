#include "tools/pipeline/frame_statistics.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "tools/pipeline/surface_statistics.h"
#include "tools/pipeline/tracker_bridge.h"

namespace flowskin::tools {

namespace {

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
  row.emitted = statistics.emitted;
  row.drained = statistics.drained;
  row.not_wanted = statistics.not_wanted;
  row.skipped_invalid = statistics.skipped_invalid;
  row.skipped_duplicates = statistics.skipped_duplicates;
  row.wall_crossings = statistics.wall_crossings;
  row.kept_out_of_gaps = statistics.kept_out_of_gaps;
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
  regions_ += report.regions;
  seconds_topology_ += report.seconds_topology;
  const double seconds[] = {report.seconds_velocity, report.seconds_projection, report.seconds_fairing,
                            report.seconds_topology};
  for (std::size_t stage = 0; stage < std::size(seconds); ++stage) tracking_seconds_[stage].second += seconds[stage];
  if (!report.reextracted) return;
  ++reextractions_;
  last_reason_ = report.reason;
}

FrameRow FrameStatistics::finish_frame(int frame, const scenes::ParticleSource& source,
                                       const tracking::Tracker* tracker, const SurfaceFrame* surface, bool is_checked) {
  FrameRow row;
  row.frame = frame;
  row.time = source.state().time;
  describe_source(source, row);
  if (tracker && surface) {
    row.max_distance = tracker->report().max_distance;
    describe_surface(surface->mesh, tracker->field().get(), tracker->state().particles, tracker->settings(), is_checked,
                     row);
    std::vector<std::uint64_t> ids = surface->mesh.ids;
    std::sort(ids.begin(), ids.end());
    row.kept_ids = count_common(ids, previous_ids_);
    if (first_ids_.empty()) first_ids_ = ids;
    row.kept_first_ids = count_common(ids, first_ids_);
    previous_ids_ = std::move(ids);
  }
  row.substeps = substeps_;
  row.splits = std::exchange(splits_, 0);
  row.collapses = std::exchange(collapses_, 0);
  row.flips = std::exchange(flips_, 0);
  row.regions = std::exchange(regions_, 0);
  row.reextractions = reextractions_;
  row.seconds_topology = std::exchange(seconds_topology_, 0);
  frames_reextracted_ += reextractions_ > 0;
  substeps_ = reextractions_ = 0;
  return row;
}

}  // namespace flowskin::tools
