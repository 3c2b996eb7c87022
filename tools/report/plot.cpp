#include "tools/report/plot.h"

#include <cairo-svg.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <regex>

#include "common/errors.h"
#include "scenes/io/atomic_file.h"
#include "tools/report/plot_panel.h"

namespace flowskin::tools {
namespace {

namespace fs = std::filesystem;

constexpr double kBorder = 12, kPanelGap = 18, kSheetTitleSize = 15;  // pixels
constexpr int kPngScale = 2;

using Surface = std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)>;
using Context = std::unique_ptr<cairo_t, void (*)(cairo_t*)>;

void check(const PlotSheet& sheet) {
  if (sheet.plots.empty() || sheet.columns < 1) throw InputError("a sheet of plots needs at least one plot and column");
  for (const Plot& plot : sheet.plots) {
    for (const Series& series : plot.series) {
      const std::size_t expected = plot.categories.empty() ? series.x.size() : plot.categories.size();
      if (series.y.size() != expected)
        throw InputError(fmt::format("plot \"{}\": series \"{}\" has {} values, but {} are expected", plot.title,
                                     series.name, series.y.size(), expected));
    }
  }
}

/// Where everything goes.
struct SheetLayout {
  double width = 0, height = 0, panels_top = kBorder;
  int columns = 1;
  PlotLegend shared;  ///< Of all panels; empty: each has its own.
  bool bars = false;
};

SheetLayout lay_out(const PlotPen& pen, const PlotSheet& sheet) {
  SheetLayout layout;
  const int count = static_cast<int>(sheet.plots.size());
  layout.columns = std::min(sheet.columns, count);
  const int rows = (count + layout.columns - 1) / layout.columns;
  layout.width = 2 * kBorder + layout.columns * sheet.panel_width + (layout.columns - 1) * kPanelGap;
  layout.bars = !sheet.plots.front().categories.empty();
  const auto same = [&](const Plot& plot) {
    return legend_of(plot) == legend_of(sheet.plots.front()) && plot.categories.empty() != layout.bars;
  };
  if (count > 1 && std::all_of(sheet.plots.begin(), sheet.plots.end(), same))
    layout.shared = legend_of(sheet.plots.front());
  if (!sheet.title.empty()) layout.panels_top += kSheetTitleSize + 12;
  const double of_legend = legend_height(pen, layout.shared, layout.width - 2 * kBorder, layout.bars);
  layout.panels_top += of_legend > 0 ? of_legend + 8 : 0;
  layout.height = layout.panels_top + rows * sheet.panel_height + (rows - 1) * kPanelGap + kBorder;
  return layout;
}

/// The one drawing routine.
void draw(cairo_t* context, const PlotSheet& sheet, const SheetLayout& layout) {
  const PlotPen pen(context);
  cairo_set_source_rgb(context, 1, 1, 1);
  cairo_paint(context);
  pen.color(kPlotInk);
  double top = kBorder;
  if (!sheet.title.empty()) {
    pen.text(kBorder + 2, top + kSheetTitleSize, kSheetTitleSize, sheet.title, Align::left, true);
    top += kSheetTitleSize + 12;
  }
  draw_legend(pen, layout.shared, {kBorder, top, layout.width - 2 * kBorder, 0}, layout.bars);
  for (std::size_t i = 0; i < sheet.plots.size(); ++i) {
    const int column = static_cast<int>(i) % layout.columns, row = static_cast<int>(i) / layout.columns;
    const PlotBox box{kBorder + column * (sheet.panel_width + kPanelGap),
                      layout.panels_top + row * (sheet.panel_height + kPanelGap), sheet.panel_width,
                      sheet.panel_height};
    draw_panel(pen, sheet.plots[i], box, layout.shared.empty());
  }
}

cairo_status_t append(void* text, const unsigned char* data, unsigned int size) {
  static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(data), size);
  return CAIRO_STATUS_SUCCESS;
}

void require(cairo_status_t status, const fs::path& file) {
  if (status != CAIRO_STATUS_SUCCESS)
    throw RunError(fmt::format("cannot draw {}: {}", file.string(), cairo_status_to_string(status)));
}

SheetLayout measured(const PlotSheet& sheet) {
  const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, 1, 1), &cairo_surface_destroy);
  const Context context(cairo_create(surface.get()), &cairo_destroy);
  return lay_out(PlotPen(context.get()), sheet);
}

std::string svg_of(const PlotSheet& sheet, const SheetLayout& layout, const fs::path& file) {
  std::string svg;
  {
    const Surface surface(cairo_svg_surface_create_for_stream(&append, &svg, layout.width, layout.height),
                          &cairo_surface_destroy);
    cairo_svg_surface_set_document_unit(surface.get(), CAIRO_SVG_UNIT_PX);
    const Context context(cairo_create(surface.get()), &cairo_destroy);
    draw(context.get(), sheet, layout);
    require(cairo_status(context.get()), file);
    cairo_surface_finish(surface.get());
    require(cairo_surface_status(surface.get()), file);
  }
  // cairo numbers its surfaces since the start of the program.
  static const std::regex surface_number("surface[0-9]+");
  return std::regex_replace(svg, surface_number, "plot");
}

std::string png_of(const PlotSheet& sheet, const SheetLayout& layout, const fs::path& file) {
  const Surface surface(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(std::lround(kPngScale * layout.width)),
                                 static_cast<int>(std::lround(kPngScale * layout.height))),
      &cairo_surface_destroy);
  const Context context(cairo_create(surface.get()), &cairo_destroy);
  cairo_scale(context.get(), kPngScale, kPngScale);
  draw(context.get(), sheet, layout);
  require(cairo_status(context.get()), file);
  std::string png;
  require(cairo_surface_write_to_png_stream(surface.get(), &append, &png), file);
  return png;
}

}  // namespace

void write_plots(const PlotSheet& sheet, const fs::path& without_extension) {
  check(sheet);
  const SheetLayout layout = measured(sheet);
  const fs::path svg = without_extension.string() + ".svg", png = without_extension.string() + ".png";
  scenes::write_file(svg, svg_of(sheet, layout, svg));
  scenes::write_file(png, png_of(sheet, layout, png));
}

void write_plot(const Plot& plot, const fs::path& without_extension) {
  write_plots({"", {plot}, 1, 640, 400}, without_extension);
}

}  // namespace flowskin::tools
