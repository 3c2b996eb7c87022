// Runs a scene through source and tracker and measures its surface at every written frame.
#pragma once

#include <filesystem>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace flowskin::surfaces {

/// What a tracked surface is to reach at every written frame, beside being sound and free of self-intersections, having
/// the components and the Euler characteristic of a fresh extraction, and never being replaced by the guard.
namespace limit {
/// Two-sided Hausdorff distance to a fresh extraction, in target edge lengths.
inline constexpr double hausdorff = 0.5;
/// Relative difference of its volume from that of a fresh extraction.
inline constexpr double volume = 0.005;
/// |f| / |grad f| at the vertices, in effective radii.
inline constexpr double field_distance = 1e-3;
/// Share of triangles whose smallest angle is below this (rad).
inline constexpr double smallest_angle = 10 * std::numbers::pi / 180;
inline constexpr double narrow_triangles = 0.001;
/// Share of edges shorter or longer than this, in target edge lengths.
inline constexpr double shortest_edge = 0.5, longest_edge = 1.5;
inline constexpr double odd_edges = 0.01;
/// Share of the vertices of the frame before that are still there, by id: where components and Euler characteristic
/// are those of the frame before, and where they are not.
inline constexpr double ids_kept = 0.98, ids_kept_through_change = 0.90;
/// Median distance between a vertex's rest position and that of the particles beneath it, at the end, in spacings.
inline constexpr double material_drift = 1;
/// Components that enclose less are left out and counted, in cubes of the target edge length: features under one cell.
inline constexpr double small_component = 1;
}  // namespace limit

/// Shape of a closed surface, the features under one cell left out.
struct Shape {
  int components = 0, euler = 0;
  int left_out = 0;        ///< Components under one cell.
  int euler_left_out = 0;  ///< Of those.
  bool same_topology(const Shape& other) const { return components == other.components && euler == other.euler; }
  /// With the features under one cell.
  bool all_the_same(const Shape& other) const {
    return components + left_out == other.components + other.left_out &&
           euler + euler_left_out == other.euler + other.euler_left_out;
  }
};

struct FrameMeasures {
  int frame = 0;
  std::size_t particles = 0, vertices = 0;
  std::vector<std::string> problems;  ///< Of mesh_problems.
  std::size_t self_intersections = 0;
  Shape shape, fresh_shape;  ///< Of the tracked surface and of a fresh extraction.
  bool borderline = false;   ///< They differ by components close to the limit of those left out, and by nothing else.
  double volume = 0;         ///< m^3
  double area_lost = 0;      ///< Share of the area of the frame before that is gone; 0 where the surface grows.
  double volume_error = 0;   ///< Relative to that of a fresh extraction.
  /// Of tracked surface and fresh extraction, relative to an extraction with edges a third as long; known in frames
  /// in which volume_error is beyond its limit.
  double true_volume_error = 0, fresh_true_volume_error = 0;
  double hausdorff = 0;  ///< Of points spread densely over both surfaces (dense_distance.h), in target edge lengths.
  double hausdorff_at_corners = 0;  ///< Of vertices and triangle centres alone, where the tracker looks, too.
  double field_distance = 0;        ///< Largest |f| / |grad f| at a vertex, in effective radii.
  double narrow_triangles = 0, odd_edges = 0;
  double ids_kept = 1;          ///< Of the vertices of the frame before.
  bool change = false;          ///< The fluid's topology is not that of the frame before, small parts included.
  double material_drift = 0;    ///< Median, in spacings; 0 where the source knows no material.
  double material_scatter = 0;  ///< The same of the particles' own material: no smooth texture drifts less.
  int regions = 0, born = 0;    ///< Replaced, and their vertices, since the frame before.
  int reextractions = 0;        ///< By the guard, since the frame before.
  std::string reason;           ///< Of the last of them.
};

/// Of a motion that brings every particle back to its start: the last surface beside the first.
struct ReturnMeasures {
  double volume_change = 0;                               ///< Relative.
  double mean_distance = 0, largest_distance = 0;         ///< Of the last vertices from the first surface (m).
  double median_texture_error = 0, texture_error_99 = 0;  /// < Between rest position and place: median, 99 % (m).
};

struct SceneMeasures {
  std::string name;
  double spacing = 0, edge_length = 0;  ///< m
  std::vector<FrameMeasures> frames;
  std::optional<ReturnMeasures> round_trip;
  double seconds_source = 0, seconds_tracking = 0, seconds_checks = 0;
};

/// @param most_frames stop after so many frames; 0: all of the scene
/// @param after_frame is called with what has been measured so far
SceneMeasures measure_scene(const std::filesystem::path& scene_file, int most_frames = 0,
                            const std::function<void(const SceneMeasures&)>& after_frame = {});

/// A limit that some frames do not keep.
struct Violation {
  std::string heading;  ///< In the table.
  int frames = 0;       ///< How many.
  double worst = 0;
  std::string sentence;  ///< All of it in words.
};
std::vector<Violation> violations(const SceneMeasures& measures);

/// Scenes with the worst frame of each measure, as aligned text or Markdown; what is beyond its limit carries a `!`.
std::string worst_table(const std::vector<SceneMeasures>& scenes);

/// The last frame of a scene with all its measures, as a line of a table; for the first frame with the table's heading.
std::string frame_line(const SceneMeasures& scene);

/// Scenes that come back: volume, return error and texture error.
std::string return_table(const std::vector<SceneMeasures>& scenes);

}  // namespace flowskin::surfaces
