// frames.csv: one row a frame.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace flowskin::tools {

/// What is known about one frame; the columns of frames.csv in this order. docs/files.md explains each.
struct FrameRow {
  int frame = 0;
  double time = 0;  ///< s
  std::uint64_t particles = 0;
  std::uint64_t vertices = 0, triangles = 0;
  int components = 0, euler = 0;                            ///< of the tracked surface
  int expected_components = 0, expected_euler = 0;          ///< of a fresh extraction
  int small_components = 0, expected_small_components = 0;  ///< of these, those below the cube of the edge length
  int same_topology = 1;  ///< 1: components and Euler characteristic as expected, small components left out
  double volume = 0, expected_volume = 0;           ///< m^3: of the tracked surface, of a fresh extraction
  double hausdorff = 0;                             ///< m: between the tracked surface and a fresh extraction
  std::uint64_t self_intersections = 0;             ///< pairs of triangles
  double area = 0;                                  ///< m^2
  double kinetic_energy = 0, potential_energy = 0;  ///< J
  double max_distance = 0;                          ///< largest |f|/|grad f| at a vertex (m)
  double smallest_angle = 0;                        ///< degrees
  double good_angles = 0, good_edges = 0;           ///< shares: above 10 degrees; 0.5 to 1.5 of the edge length
  double stretch_median = 0, stretch_p99 = 0;       ///< larger singular value of the map from rest to present
  double overstretched = 0;     ///< share of the area whose texture, as shown, is stretched past the limit
  double texture_drift = 0;     ///< m: median distance between the rest positions of surface and particles beneath
  double material_scatter = 0;  ///< m: the same between a particle's and that of its neighbours: the drift's floor
  int substeps = 0;
  int splits = 0, collapses = 0, flips = 0;  ///< of the remeshing
  int regions = 0;                           ///< of the surface, replaced where it no longer fitted
  int reextractions = 0;                     ///< how often the guard replaced the mesh in this frame
  int kept_ids = 0;                          ///< vertices that were there in the frame before
  std::uint64_t steps = 0;                   ///< solver steps since the start
  double time_step = 0;                      ///< s, the last one
  double mean_density_error = 0, max_density_error = 0;
  std::uint64_t left_domain = 0, emitted = 0, drained = 0;  ///< since the start
  std::uint64_t wall_crossings = 0, kept_out_of_gaps = 0;   ///< since the start
  double seconds_source = 0, seconds_tracking = 0, seconds_topology = 0, seconds_writing = 0, seconds_pictures = 0,
         seconds_statistics = 0;

  template <class Archive>
  void visit(Archive& archive);
};

/// Calls visit(name, value) for each column: header, rows and saved rows cannot disagree.
template <class Row, class Visit>
void for_each_frame_column(Row& row, Visit visit) {
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
  visit("material_scatter", row.material_scatter);
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
  visit("kept_out_of_gaps", row.kept_out_of_gaps);
  visit("seconds_source", row.seconds_source);
  visit("seconds_tracking", row.seconds_tracking);
  visit("seconds_topology", row.seconds_topology);
  visit("seconds_writing", row.seconds_writing);
  visit("seconds_pictures", row.seconds_pictures);
  visit("seconds_statistics", row.seconds_statistics);
}

template <class Archive>
void FrameRow::visit(Archive& archive) {
  for_each_frame_column(*this, [&](const char*, auto& value) { archive(value); });
}

/// Writes all rows, whole or not at all. @throws RunError
void write_frames_csv(const std::filesystem::path& file, const std::vector<FrameRow>& rows);

}  // namespace flowskin::tools
