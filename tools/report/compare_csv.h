// compare.csv: one row a frame and velocity method.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace flowskin::tools {

/// How well a method does in one frame; the columns of compare.csv in this order. docs/compare.md explains each.
/// Lengths in m; errors are against passive markers, relative ones are of root mean squares over the surface.
struct CompareRow {
  int frame = 0;
  double time = 0;  ///< s
  std::string method;
  std::uint64_t vertices = 0, triangles = 0;
  int components = 0;
  // Of the markers, the same for all methods.
  int markers = 0, markers_left = 0;  ///< on the surface; that have left it
  double marker_depth = 0;            ///< median |f| / |grad f| at the markers
  double marker_drift = 0;            ///< median distance of their rest positions from those of the particles around
  // Of the mesh against the markers.
  double texture_median = 0, texture_p90 = 0, texture_rms = 0, texture_found = 0;
  double path_median = 0, path_p90 = 0, path_rms = 0, path_found = 0;
  double vertex_path_median = 0, vertex_path_rms = 0, vertices_kept = 0;
  // Of its velocity against the flow.
  double velocity_error = 0, tangential_error = 0;  ///< relative
  double flow_speed = 0, tangential_speed = 0;      ///< m/s, root mean square of the flow over the surface
  // Of the mesh by itself and against the particles.
  double texture_drift = 0;                             ///< as in frames.csv
  double max_distance = 0;                              ///< largest |f| / |grad f| at a vertex
  double angle_min = 0, angle_p05 = 0, angle_mean = 0;  ///< degrees, of the smallest angles of the triangles
  double stretch_median = 0, stretch_p99 = 0;
  int reextractions = 0, splits = 0, collapses = 0, flips = 0;
  double seconds = 0;  ///< of tracking, in this frame

  template <class Archive>
  void visit(Archive& archive);
};

/// Calls visit(name, value) for each column: header, rows and saved rows cannot disagree.
template <class Row, class Visit>
void for_each_compare_column(Row& row, Visit visit) {
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

template <class Archive>
void CompareRow::visit(Archive& archive) {
  for_each_compare_column(*this, [&](const char*, auto& value) { archive(value); });
}

/// Writes all rows, whole or not at all. @throws RunError
void write_compare_csv(const std::filesystem::path& file, const std::vector<CompareRow>& rows);

}  // namespace flowskin::tools
