// The limits, and the tables.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string_view>

#include "surfaces/surface_checks.h"

namespace flowskin::surfaces {
namespace {

/// One of the lines: a number per frame, the larger the worse, and the limit above which it fails.
struct Line {
  const char* name;
  const char* heading;  ///< In the table.
  double limit;
  std::function<double(const FrameMeasures&)> value;
  const char* format;
  bool last_frame_only = false;
};

double difference(int a, int b) { return std::abs(a - b); }

const std::vector<Line>& lines() {
  static const std::vector<Line> all = {
      {"unsound mesh", "unsound", 0, [](const auto& f) { return double(f.problems.size()); }, "{:.0f}"},
      {"self-intersections", "crossings", 0, [](const auto& f) { return double(f.self_intersections); }, "{:.0f}"},
      {"components wrong by", "components", 0,
       [](const auto& f) { return f.borderline ? 0 : difference(f.shape.components, f.fresh_shape.components); },
       "{:.0f}"},
      {"Euler characteristic wrong by", "Euler", 0,
       [](const auto& f) { return f.borderline ? 0 : difference(f.shape.euler, f.fresh_shape.euler); }, "{:.0f}"},
      {"Hausdorff distance in edge lengths", "Hausdorff", limit::hausdorff, [](const auto& f) { return f.hausdorff; },
       "{:.2f}"},
      {"Hausdorff distance of vertices and centres in edge lengths", "at corners", limit::hausdorff,
       [](const auto& f) { return f.hausdorff_at_corners; }, "{:.2f}"},
      {"relative volume error", "volume %", limit::volume, [](const auto& f) { return f.volume_error; }, "{:.2f}%"},
      {"|f|/|grad f| in effective radii", "|f| 1e-3", limit::field_distance,
       [](const auto& f) { return f.field_distance; }, "{:.3f}m"},
      {"share of triangles with an angle below 10 degrees", "narrow %", limit::narrow_triangles,
       [](const auto& f) { return f.narrow_triangles; }, "{:.2f}%"},
      {"share of edges outside of 0.5 to 1.5 edge lengths", "edges %", limit::odd_edges,
       [](const auto& f) { return f.odd_edges; }, "{:.2f}%"},
      {"share of ids lost without a topology change", "ids lost %", 1 - limit::ids_kept,
       [](const auto& f) { return f.change ? 0 : 1 - f.ids_kept; }, "{:.2f}%"},
      {"share of the area lost", "area lost %", 1, [](const auto& f) { return f.area_lost; }, "{:.2f}%"},
      {"share of ids lost with a topology change", "with change %", 1 - limit::ids_kept_through_change,
       [](const auto& f) { return f.change ? 1 - f.ids_kept : 0; }, "{:.2f}%"},
      {"re-extractions by the guard", "guard", 0, [](const auto& f) { return double(f.reextractions); }, "{:.0f}"},
      {"median material drift at the end in spacings", "drift", limit::material_drift,
       [](const auto& f) { return f.material_drift; }, "{:.2f}", true},
      {"median scatter of the particles' material at the end in spacings", "scatter",
       std::numeric_limits<double>::infinity(), [](const auto& f) { return f.material_scatter; }, "{:.2f}", true},
  };
  return all;
}

/// % and m at the end of a format: per cent, thousandths.
std::string text_of(const Line& line, double value) {
  std::string format = line.format;
  if (format.back() == '%') value *= 100;
  if (format.back() == 'm') value *= 1000;
  if (format.back() != '}') format.pop_back();
  return fmt::format(fmt::runtime(format), value);
}

struct Worst {
  double value = 0;
  int frame = 0;
  int beyond = 0;  ///< Frames beyond the limit.
};

Worst worst_of(const Line& line, const SceneMeasures& scene) {
  Worst worst;
  for (const FrameMeasures& frame : scene.frames) {
    if (line.last_frame_only && &frame != &scene.frames.back()) continue;
    const double value = line.value(frame);
    worst.beyond += !(value <= line.limit + 1e-12);
    // A value that is no number is the worst of all.
    if (!std::isnan(worst.value) && !(value <= worst.value)) worst = {value, frame.frame, worst.beyond};
  }
  return worst;
}

/// Rows of cells, the first one the heading, as a Markdown table with aligned columns.
std::string aligned(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) text += fmt::format("| {:>{}} ", row[i], widths[i]);
    text += "|\n";
    if (&row != &rows.front()) continue;
    for (const std::size_t width : widths) text += "|" + std::string(width + 1, '-') + ":";
    text += "|\n";
  }
  return text;
}

}  // namespace

std::vector<Violation> violations(const SceneMeasures& measures) {
  std::vector<Violation> found;
  for (const Line& line : lines()) {
    const Worst worst = worst_of(line, measures);
    if (worst.beyond == 0) continue;
    const auto& frame = *std::find_if(measures.frames.begin(), measures.frames.end(),
                                      [&](const FrameMeasures& f) { return f.frame == worst.frame; });
    std::string sentence =
        fmt::format("{}: {}: {} of {} frames beyond {:g}; worst {:g} in frame {}", measures.name, line.name,
                    worst.beyond, measures.frames.size(), line.limit, worst.value, worst.frame);
    if (line.name == lines().front().name) sentence += ": " + frame.problems.front();
    if (&line == &lines()[2] || &line == &lines()[3])
      sentence += fmt::format(": components {} for {}, Euler characteristic {} for {}", frame.shape.components,
                              frame.fresh_shape.components, frame.shape.euler, frame.fresh_shape.euler);
    if (line.heading == std::string_view("volume %")) {
      sentence += fmt::format(" (against cells a third as long: mesh {:+.2f} %, fresh extraction {:+.2f} %)",
                              100 * frame.true_volume_error, 100 * frame.fresh_true_volume_error);
    }
    if (frame.reextractions > 0) sentence += " (the guard: " + frame.reason + ")";
    found.push_back({line.heading, worst.beyond, worst.value, sentence});
  }
  return found;
}

std::string worst_table(const std::vector<SceneMeasures>& scenes) {
  std::vector<std::vector<std::string>> rows(1, {"scene", "frames", "particles", "vertices", "small parts"});
  for (const Line& line : lines()) rows[0].push_back(line.heading);
  for (const char* heading : {"source s", "tracking s", "checks s"}) rows[0].push_back(heading);
  for (const SceneMeasures& scene : scenes) {
    const FrameMeasures& last = scene.frames.back();
    int small_parts = 0;
    for (const FrameMeasures& frame : scene.frames)
      small_parts = std::max({small_parts, frame.shape.left_out, frame.fresh_shape.left_out});
    std::vector<std::string> row = {scene.name, fmt::format("{}", last.frame), fmt::format("{}", last.particles),
                                    fmt::format("{}", last.vertices), fmt::format("{}", small_parts)};
    for (const Line& line : lines()) {
      const Worst worst = worst_of(line, scene);
      row.push_back(text_of(line, worst.value) + (worst.beyond > 0 ? fmt::format(" !{}", worst.beyond) : ""));
    }
    for (const double seconds : {scene.seconds_source, scene.seconds_tracking, scene.seconds_checks})
      row.push_back(fmt::format("{:.1f}", seconds));
    rows.push_back(row);
  }
  return aligned(rows);
}

std::string frame_line(const SceneMeasures& scene) {
  std::string heading = fmt::format("{:>5} {:>8} {:>7} {:>6}", "frame", "vertices", "regions", "born"), text;
  const FrameMeasures& frame = scene.frames.back();
  text = fmt::format("{:>5} {:>8} {:>7} {:>6}", frame.frame, frame.vertices, frame.regions, frame.born);
  for (const Line& line : lines()) {
    const double value = line.value(frame);
    const std::size_t width = std::max<std::size_t>(8, std::string_view(line.heading).size());
    heading += fmt::format(" {:>{}} ", line.heading, width);
    text += fmt::format(" {:>{}}{}", text_of(line, value), width, value <= line.limit + 1e-12 ? ' ' : '!');
  }
  heading += fmt::format(" {:>8} {:>8}", "source s", "tracking s");
  text += fmt::format(" {:>8.1f} {:>8.1f}", scene.seconds_source, scene.seconds_tracking);
  return (scene.frames.size() == 1 ? heading + "\n" : "") + text + "\n";
}

std::string return_table(const std::vector<SceneMeasures>& scenes) {
  std::vector<std::vector<std::string>> rows(1, {"scene", "spacing (m)", "volume %", "largest volume change %",
                                                 "return mean (m)", "largest (m)", "texture median (m)", "99 % (m)"});
  for (const SceneMeasures& scene : scenes) {
    if (!scene.round_trip) continue;
    double largest = 0;
    for (const FrameMeasures& frame : scene.frames) {
      const double change = frame.volume / scene.frames.front().volume - 1;
      if (std::abs(change) > std::abs(largest)) largest = change;
    }
    const ReturnMeasures& back = *scene.round_trip;
    rows.push_back({scene.name, fmt::format("{:g}", scene.spacing), fmt::format("{:+.3f}", 100 * back.volume_change),
                    fmt::format("{:+.2f}", 100 * largest), fmt::format("{:.2e}", back.mean_distance),
                    fmt::format("{:.2e}", back.largest_distance), fmt::format("{:.2e}", back.median_texture_error),
                    fmt::format("{:.2e}", back.texture_error_99)});
  }
  return aligned(rows);
}

}  // namespace flowskin::surfaces
