#include "tools/report/plot_pen.h"

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

namespace flowskin::tools {
namespace {

constexpr const char* kFontName = "DejaVu Sans";
constexpr double kLineWidth = 1.8;

// Okabe and Ito's palette; its yellow, which white paper swallows, is replaced by grey.
constexpr std::array<PlotColor, 8> kPalette{{{0.000, 0.447, 0.698},
                                             {0.835, 0.369, 0.000},
                                             {0.000, 0.620, 0.451},
                                             {0.800, 0.475, 0.655},
                                             {0.902, 0.624, 0.000},
                                             {0.337, 0.706, 0.914},
                                             {0.000, 0.000, 0.000},
                                             {0.550, 0.550, 0.550}}};

// In line widths: drawn, left out, drawn, ...
const std::array<std::vector<double>, 4> kDashes{{{}, {5, 2}, {1.5, 1.5}, {6, 1.5, 1.5, 1.5}}};

std::size_t in_turn(int style, std::size_t count) { return static_cast<std::size_t>(style) % count; }

/// A regular star or polygon: corners alternate between both radii.
void star_path(cairo_t* context, double x, double y, int corners, double outer, double inner, double turn) {
  for (int k = 0; k < corners; ++k) {
    const double angle = turn + 2 * std::numbers::pi * k / corners;
    const double radius = k % 2 == 0 ? outer : inner;
    cairo_line_to(context, x + radius * std::sin(angle), y - radius * std::cos(angle));
  }
  cairo_close_path(context);
}

}  // namespace

PlotPen::PlotPen(cairo_t* context) : context_(context) {
  const std::unique_ptr<cairo_font_options_t, void (*)(cairo_font_options_t*)> options(cairo_font_options_create(),
                                                                                       &cairo_font_options_destroy);
  cairo_font_options_set_antialias(options.get(), CAIRO_ANTIALIAS_GRAY);
  cairo_font_options_set_hint_style(options.get(), CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
  cairo_set_font_options(context_, options.get());
}

void PlotPen::color(const PlotColor& color, double alpha) const {
  cairo_set_source_rgba(context_, color[0], color[1], color[2], alpha);
}

void PlotPen::font(double size, bool bold) const {
  cairo_select_font_face(context_, kFontName, CAIRO_FONT_SLANT_NORMAL,
                         bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(context_, size);
}

double PlotPen::text_width(const std::string& text, double size, bool bold) const {
  font(size, bold);
  cairo_text_extents_t extents;
  cairo_text_extents(context_, text.c_str(), &extents);
  return extents.x_advance;
}

void PlotPen::text(double x, double y, double size, const std::string& text, Align align, bool bold) const {
  const double width = text_width(text, size, bold);
  const double left = align == Align::left ? x : align == Align::center ? x - 0.5 * width : x - width;
  cairo_move_to(context_, left, y);
  cairo_show_text(context_, text.c_str());
}

void PlotPen::text_upwards(double x, double y, double size, const std::string& words) const {
  cairo_save(context_);
  cairo_translate(context_, x, y);
  cairo_rotate(context_, -0.5 * std::numbers::pi);
  text(0, 0, size, words, Align::center);
  cairo_restore(context_);
}

void PlotPen::line(double x0, double y0, double x1, double y1, double width) const {
  cairo_set_line_width(context_, width);
  cairo_move_to(context_, x0, y0);
  cairo_line_to(context_, x1, y1);
  cairo_stroke(context_);
}

PlotColor style_color(int style) { return kPalette[in_turn(style, kPalette.size())]; }

void use_line_style(const PlotPen& pen, int style) {
  pen.color(style_color(style));
  std::vector<double> pattern = kDashes[in_turn(style, kDashes.size())];
  for (double& length : pattern) length *= kLineWidth;
  cairo_set_dash(pen.context(), pattern.data(), static_cast<int>(pattern.size()), 0);
  cairo_set_line_width(pen.context(), kLineWidth);
  cairo_set_line_join(pen.context(), CAIRO_LINE_JOIN_ROUND);
}

void draw_marker(const PlotPen& pen, int style, double x, double y) {
  cairo_t* context = pen.context();
  constexpr double r = kPlotMarkerSize;
  constexpr double quarter = 0.25 * std::numbers::pi;
  cairo_new_path(context);
  switch (in_turn(style, 8)) {
    case 0:
      cairo_arc(context, x, y, r, 0, 2 * std::numbers::pi);
      cairo_close_path(context);
      break;
    case 1:
      star_path(context, x, y, 4, 1.25 * r, 1.25 * r, quarter);
      break;  // square
    case 2:
      star_path(context, x, y, 3, 1.4 * r, 1.4 * r, 0);
      break;  // triangle up
    case 3:
      star_path(context, x, y, 4, 1.4 * r, 1.4 * r, 0);
      break;  // diamond
    case 4:
      star_path(context, x, y, 3, 1.4 * r, 1.4 * r, 4 * quarter);
      break;  // triangle down
    case 5:
      star_path(context, x, y, 10, 1.6 * r, 0.65 * r, 0);
      break;  // star
    case 6:
      star_path(context, x, y, 8, 1.6 * r, 0.5 * r, quarter);
      break;  // cross
    default:
      star_path(context, x, y, 6, 1.3 * r, 1.3 * r, 0);
      break;  // hexagon
  }
  cairo_set_dash(context, nullptr, 0, 0);
  cairo_set_line_width(context, 1.6);
  cairo_set_source_rgb(context, 1, 1, 1);
  cairo_stroke_preserve(context);
  pen.color(style_color(style));
  cairo_fill(context);
}

}  // namespace flowskin::tools
