// One panel of a sheet of plots. Internal to the plots.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tools/report/plot.h"
#include "tools/report/plot_pen.h"

namespace flowskin::tools {

/// A place on the sheet (pixels).
struct PlotBox {
  double x = 0, y = 0, width = 0, height = 0;
};

/// Name and style of each line of a legend.
using PlotLegend = std::vector<std::pair<std::string, int>>;

PlotLegend legend_of(const Plot& plot);
/// Height of the legend in a place of this width; 0 where it is empty.
double legend_height(const PlotPen& pen, const PlotLegend& legend, double width, bool bars);
/// Entries side by side, in as many rows as it takes.
void draw_legend(const PlotPen& pen, const PlotLegend& legend, const PlotBox& box, bool bars);

/// Title, axes, lines or bars, and what was left out.
void draw_panel(const PlotPen& pen, const Plot& plot, const PlotBox& box, bool with_legend);

}  // namespace flowskin::tools
