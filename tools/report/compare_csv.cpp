#include "tools/report/compare_csv.h"

#include "tools/io/atomic_file.h"
#include "tools/report/csv_text.h"

namespace flowskin::tools {
namespace {

/// Calls visit(name, value) for each column: the header and the rows cannot disagree.
template <class Visit>
void for_each_column(const CompareRow& row, Visit visit) {
  visit("frame", row.frame);
  visit("time", row.time);
  visit("method", row.method);
  visit("vertices", row.vertices);
  visit("triangles", row.triangles);
  visit("components", row.components);
  visit("markers", row.markers);
  visit("markers_left", row.markers_left);
  visit("marker_depth", row.marker_depth);
  visit("marker_drift", row.marker_drift);
  visit("texture_median", row.texture_median);
  visit("texture_p90", row.texture_p90);
  visit("texture_rms", row.texture_rms);
  visit("texture_found", row.texture_found);
  visit("path_median", row.path_median);
  visit("path_p90", row.path_p90);
  visit("path_rms", row.path_rms);
  visit("path_found", row.path_found);
  visit("vertex_path_median", row.vertex_path_median);
  visit("vertex_path_rms", row.vertex_path_rms);
  visit("vertices_kept", row.vertices_kept);
  visit("velocity_error", row.velocity_error);
  visit("tangential_error", row.tangential_error);
  visit("flow_speed", row.flow_speed);
  visit("tangential_speed", row.tangential_speed);
  visit("texture_drift", row.texture_drift);
  visit("max_distance", row.max_distance);
  visit("angle_min", row.angle_min);
  visit("angle_p05", row.angle_p05);
  visit("angle_mean", row.angle_mean);
  visit("stretch_median", row.stretch_median);
  visit("stretch_p99", row.stretch_p99);
  visit("reextractions", row.reextractions);
  visit("splits", row.splits);
  visit("collapses", row.collapses);
  visit("flips", row.flips);
  visit("seconds", row.seconds);
}

}  // namespace

void write_compare_csv(const std::filesystem::path& file, const std::vector<CompareRow>& rows) {
  write_file(file, csv_text(rows, [](const auto& row, const auto& visit) { for_each_column(row, visit); }));
}

}  // namespace flowskin::tools
