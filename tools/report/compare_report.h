// What a comparison of velocity methods comes to: plots over time, and a ranking.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/report/compare_csv.h"
#include "tools/report/plot.h"

namespace flowskin::tools {

/// A method over the whole run; lengths in particle spacings.
struct MethodScore {
  std::string method;
  double texture = 0, path = 0;         ///< Means over the frames after the first of the median errors.
  double texture_at_end = 0;            ///< Median in the last frame.
  double velocity = 0, tangential = 0;  ///< Root mean square error over surface and time, relative to that of the flow.
  double drift = 0;                     ///< Mean over the frames of texture_drift.
  double stretch_p99 = 0;               ///< In the last frame.
  int reextractions = 0;
  double seconds = 0;  ///< Of tracking, in all.
};

/// Best first: by texture error; equal ones in the order of the rows.
std::vector<MethodScore> rank_methods(const std::vector<CompareRow>& rows, double spacing);

/// The ranking as a table of plain text, a line each, the head first.
std::vector<std::string> ranking_lines(const std::vector<MethodScore>& ranking);

/// One panel an error, over time; methods in the order of the rows.
PlotSheet compare_plots(const std::string& scene, const std::vector<CompareRow>& rows, double spacing);

/// What table, plots and log say of max_slip: the same for all methods.
inline constexpr const char* kSlipFreely = "the texture slips freely in all of them: max_slip is 0";

/// What compare.md says beside the tables.
struct CompareSetting {
  std::string scene;
  double spacing = 0;         ///< m
  std::string truth;          ///< Where the true velocity comes from, in words.
  double scene_max_slip = 0;  ///< Of the scene's own run (m), which is not compared where this is not 0.
  bool has_pictures = false, has_video = false;
};

/// The ranking with a word on how it was measured, in Markdown. @throws RunError
void write_compare_markdown(const std::filesystem::path& file, const CompareSetting& setting,
                            const std::vector<CompareRow>& rows);

}  // namespace flowskin::tools
