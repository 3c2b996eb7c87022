#include "tools/report/compare_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "scenes/io/atomic_file.h"

namespace flowskin::tools {
namespace {

/// Names of the methods in the order of the rows.
std::vector<std::string> methods_of(const std::vector<CompareRow>& rows) {
  std::vector<std::string> methods;
  for (const CompareRow& row : rows) {
    if (std::find(methods.begin(), methods.end(), row.method) == methods.end()) methods.push_back(row.method);
  }
  return methods;
}

double relative_error(double error_squares, double flow_squares) {
  return flow_squares > 0 ? std::sqrt(error_squares / flow_squares) : 0;
}

MethodScore score_of(const std::string& method, const std::vector<CompareRow>& rows, double spacing) {
  MethodScore score;
  score.method = method;
  int frames = 0;
  double error = 0, flow = 0, tangential_error = 0, tangential_flow = 0;
  for (const CompareRow& row : rows) {
    if (row.method != method) continue;
    const auto square = [](double value) { return value * value; };
    error += square(row.velocity_error * row.flow_speed);
    flow += square(row.flow_speed);
    tangential_error += square(row.tangential_error * row.tangential_speed);
    tangential_flow += square(row.tangential_speed);
    score.reextractions += row.reextractions;
    score.seconds += row.seconds;
    score.texture_at_end = row.texture_median / spacing;
    score.stretch_p99 = row.stretch_p99;
    if (row.frame == 0) continue;
    ++frames;
    score.texture += row.texture_median / spacing;
    score.path += row.path_median / spacing;
    score.drift += row.texture_drift / spacing;
  }
  for (double* mean : {&score.texture, &score.path, &score.drift}) *mean /= std::max(1, frames);
  score.velocity = relative_error(error, flow);
  score.tangential = relative_error(tangential_error, tangential_flow);
  return score;
}

using Value = std::function<double(const CompareRow&)>;

Plot panel(const std::vector<CompareRow>& rows, const std::string& title, const std::string& y_label,
           const Value& value) {
  Plot plot;
  plot.title = title;
  plot.x_label = "time (s)";
  plot.y_label = y_label;
  for (const std::string& method : methods_of(rows)) {
    Series series;
    series.name = method;
    for (const CompareRow& row : rows) {
      if (row.method != method) continue;
      series.x.push_back(row.time);
      series.y.push_back(value(row));
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

}  // namespace

std::vector<MethodScore> rank_methods(const std::vector<CompareRow>& rows, double spacing) {
  std::vector<MethodScore> ranking;
  for (const std::string& method : methods_of(rows)) ranking.push_back(score_of(method, rows, spacing));
  std::stable_sort(ranking.begin(), ranking.end(),
                   [](const MethodScore& a, const MethodScore& b) { return a.texture < b.texture; });
  return ranking;
}

std::vector<std::string> ranking_lines(const std::vector<MethodScore>& ranking) {
  std::vector<std::string> lines;
  lines.push_back(fmt::format("{:>4} {:<18} {:>10} {:>10} {:>10} {:>10} {:>10} {:>8} {:>8} {:>9}", "rank", "method",
                              "texture", "at end", "path", "velocity", "tangential", "stretch", "anew", "seconds"));
  int rank = 0;
  for (const MethodScore& score : ranking) {
    lines.push_back(
        fmt::format("{:>4} {:<18} {:>10.4f} {:>10.4f} {:>10.4f} {:>10.4f} {:>10.4f} {:>8.2f} {:>8} {:>9.2f}", ++rank,
                    score.method, score.texture, score.texture_at_end, score.path, score.velocity, score.tangential,
                    score.stretch_p99, score.reextractions, score.seconds));
  }
  return lines;
}

PlotSheet compare_plots(const std::string& scene, const std::vector<CompareRow>& rows, double spacing) {
  PlotSheet sheet;
  sheet.title = scene + ": velocity methods against passive markers (all with max_slip 0)";
  const auto in_spacings = [spacing](double CompareRow::*member) -> Value {
    return [=](const CompareRow& row) { return row.*member / spacing; };
  };
  const auto plain = [](double CompareRow::*member) -> Value {
    return [=](const CompareRow& row) { return row.*member; };
  };
  const std::string spacings = "particle spacings";
  sheet.plots = {panel(rows, "Texture error, median", spacings, in_spacings(&CompareRow::texture_median)),
                 panel(rows, "Path error, median", spacings, in_spacings(&CompareRow::path_median)),
                 panel(rows, "Velocity error", "share of the speed", plain(&CompareRow::velocity_error)),
                 panel(rows, "Tangential velocity error", "share of the speed", plain(&CompareRow::tangential_error)),
                 panel(rows, "Texture stretch, 99th percentile", "factor", plain(&CompareRow::stretch_p99)),
                 panel(rows, "Smallest angles, 5th percentile", "degrees", plain(&CompareRow::angle_p05)),
                 panel(rows, "Largest distance to f = 0", spacings, in_spacings(&CompareRow::max_distance)),
                 panel(rows, "Texture off the particles' material", spacings, in_spacings(&CompareRow::texture_drift))};
  sheet.plots[4].log_y = sheet.plots[6].log_y = true;
  if (!rows.empty()) {
    const CompareRow& last = rows.back();
    sheet.plots[7].note = fmt::format("the markers themselves at the end: {:.3g}", last.marker_drift / spacing);
    sheet.plots[0].note = fmt::format("{} of {} markers have left the surface at the end", last.markers_left,
                                      last.markers + last.markers_left);
  }
  sheet.panel_height = 270;
  return sheet;
}

void write_compare_markdown(const std::filesystem::path& file, const CompareSetting& setting,
                            const std::vector<CompareRow>& rows) {
  std::string text = fmt::format("# {}: velocity methods compared\n\n", setting.scene);
  text += fmt::format(
      "Errors of the surface against passive markers that ride {}. Texture and path errors are medians over the\n"
      "markers, averaged over the frames, in particle spacings ({:.4g} m); velocity errors are root mean squares over "
      "surface\nand time, relative to the speed. docs/compare.md explains how they are measured.\n\n"
      "All methods in the same conditions: {}, so that each shows what its velocity does.",
      setting.truth, setting.spacing, kSlipFreely);
  if (setting.scene_max_slip > 0)
    text += fmt::format(
        "\nThe surface in surface/ is another one: the scene holds its texture within max_slip = {:.4g} m of its "
        "particles.",
        setting.scene_max_slip);
  text += "\n\n";
  text +=
      "| rank | method | texture error | at the end | path error | velocity error | tangential | off the particles | "
      "stretch (p99, at the end) | extracted anew | tracking (s) |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n";
  int rank = 0;
  for (const MethodScore& score : rank_methods(rows, setting.spacing)) {
    text += fmt::format("| {} | {} | {:.4f} | {:.4f} | {:.4f} | {:.4f} | {:.4f} | {:.4f} | {:.2f} | {} | {:.1f} |\n",
                        ++rank, score.method, score.texture, score.texture_at_end, score.path, score.velocity,
                        score.tangential, score.drift, score.stretch_p99, score.reextractions, score.seconds);
  }
  if (!rows.empty()) {
    const CompareRow& last = rows.back();
    text += fmt::format(
        "\nAt the end {} of {} markers have left the surface and no longer count; the others are {:.3g} spacings off "
        "it "
        "in the\nmedian, and their material is {:.3g} spacings from that of the particles around them.\n",
        last.markers_left, last.markers + last.markers_left, last.marker_depth / setting.spacing,
        last.marker_drift / setting.spacing);
  }
  text += "\n![errors over time](compare.svg)\n";
  if (setting.has_pictures) text += "\n![the surfaces](compare_sheet.png)\n";
  if (setting.has_video) text += "\nSide by side: [compare.mp4](compare.mp4). ";
  text += "\nAll numbers: [compare.csv](compare.csv).\n";
  scenes::write_file(file, text);
}

}  // namespace flowskin::tools
