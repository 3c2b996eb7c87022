// Plots for reports: lines over x or bars in groups, as SVG and PNG.
#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace flowskin::tools {

/// One line of a plot. Its colour, dashes and marker follow from its place among the series.
struct Series {
  std::string name;       ///< For the legend; empty: not in it.
  std::vector<double> x;  ///< Of bars: ignored.
  std::vector<double> y;  ///< As many as x. NaN: a gap in the line, or no bar.
  int style = -1;         ///< Number of the style (colour, dashes, marker); -1: the place among the series.
};

/// One panel. Labels name the quantity and its unit.
struct Plot {
  std::string title, x_label, y_label;
  bool log_x = false, log_y = false;  ///< Values that a logarithmic axis cannot show are left out; the plot says so.
  std::vector<Series> series;
  std::vector<std::string> categories;  ///< Not empty: bars, y[i] of each series stands in group i.
  /// Limits of the y axis; NaN: from the values. Lines that leave them are cut off; the plot says so.
  double y_low = std::numeric_limits<double>::quiet_NaN(), y_high = std::numeric_limits<double>::quiet_NaN();
  std::string note;  ///< Small print below.
};

/// Panels side by side, row by row.
struct PlotSheet {
  std::string title;
  std::vector<Plot> plots;
  int columns = 2;
  double panel_width = 460, panel_height = 300;  ///< Pixels; a PNG has twice as many.
};

/// Writes without_extension.svg and without_extension.png (twice the resolution), each whole or not at all. The same
/// plot gives the same bytes. Where all panels have the same series, one legend serves them all.
/// @throws InputError where x and y of a series differ in size, or a sheet is empty; RunError where a file cannot be
/// written.
void write_plots(const PlotSheet& sheet, const std::filesystem::path& without_extension);

/// A sheet of one panel.
void write_plot(const Plot& plot, const std::filesystem::path& without_extension);

}  // namespace flowskin::tools
