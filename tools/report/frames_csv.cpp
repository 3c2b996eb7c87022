#include "tools/report/frames_csv.h"

#include <string>

#include "tools/io/atomic_file.h"
#include "tools/report/csv_text.h"

namespace flowskin::tools {

namespace {

/// Calls visit(name, value) for each column: the header and the rows cannot disagree.
template <class Visit>
void for_each_column(const FrameRow& row, Visit visit) {
  visit("frame", row.frame);
  visit("time", row.time);
  visit("particles", row.particles);
  visit("vertices", row.vertices);
  visit("triangles", row.triangles);
  visit("components", row.components);
  visit("euler", row.euler);
  visit("expected_components", row.expected_components);
  visit("expected_euler", row.expected_euler);
  visit("small_components", row.small_components);
  visit("expected_small_components", row.expected_small_components);
  visit("same_topology", row.same_topology);
  visit("volume", row.volume);
  visit("expected_volume", row.expected_volume);
  visit("hausdorff", row.hausdorff);
  visit("self_intersections", row.self_intersections);
  visit("area", row.area);
  visit("kinetic_energy", row.kinetic_energy);
  visit("potential_energy", row.potential_energy);
  visit("max_distance", row.max_distance);
  visit("smallest_angle", row.smallest_angle);
  visit("good_angles", row.good_angles);
  visit("good_edges", row.good_edges);
  visit("stretch_median", row.stretch_median);
  visit("stretch_p99", row.stretch_p99);
  visit("overstretched", row.overstretched);
  visit("texture_drift", row.texture_drift);
  visit("substeps", row.substeps);
  visit("splits", row.splits);
  visit("collapses", row.collapses);
  visit("flips", row.flips);
  visit("regions", row.regions);
  visit("reextractions", row.reextractions);
  visit("kept_ids", row.kept_ids);
  visit("steps", row.steps);
  visit("time_step", row.time_step);
  visit("mean_density_error", row.mean_density_error);
  visit("max_density_error", row.max_density_error);
  visit("left_domain", row.left_domain);
  visit("emitted", row.emitted);
  visit("drained", row.drained);
  visit("wall_crossings", row.wall_crossings);
  visit("seconds_source", row.seconds_source);
  visit("seconds_tracking", row.seconds_tracking);
  visit("seconds_topology", row.seconds_topology);
  visit("seconds_writing", row.seconds_writing);
  visit("seconds_pictures", row.seconds_pictures);
  visit("seconds_statistics", row.seconds_statistics);
}

}  // namespace

void write_frames_csv(const std::filesystem::path& file, const std::vector<FrameRow>& rows) {
  write_file(file, csv_text(rows, [](const auto& row, const auto& visit) { for_each_column(row, visit); }));
}

}  // namespace flowskin::tools
