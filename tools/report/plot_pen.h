// Drawing with cairo, in the look that all plots share. Internal to the plots.
#pragma once

#include <cairo.h>

#include <array>
#include <string>

namespace flowskin::tools {

using PlotColor = std::array<double, 3>;
constexpr PlotColor kPlotInk{0.13, 0.14, 0.16}, kPlotPaleInk{0.42, 0.44, 0.47}, kPlotGrid{0.89, 0.90, 0.91};

enum class Align { left, center, right };

/// Text and lines; lengths in pixels, y downwards. Never owns the context.
class PlotPen {
 public:
  explicit PlotPen(cairo_t* context);

  cairo_t* context() const { return context_; }
  void color(const PlotColor& color, double alpha = 1) const;
  double text_width(const std::string& text, double size, bool bold = false) const;
  /// One line of text; (x, y) is the left end, the middle or the right end of its base line.
  void text(double x, double y, double size, const std::string& text, Align align, bool bold = false) const;
  /// The same, read upwards: (x, y) is the middle of its base line.
  void text_upwards(double x, double y, double size, const std::string& text) const;
  void line(double x0, double y0, double x1, double y1, double width) const;

 private:
  void font(double size, bool bold) const;
  cairo_t* context_;
};

constexpr double kPlotMarkerSize = 3.2;

/// Colour of a style, colour-blind safe [Okabe and Ito 2008].
PlotColor style_color(int style);
/// Line width, dashes and colour of a style; then stroke.
void use_line_style(const PlotPen& pen, int style);
/// The marker of a style, filled in its colour with a white rim.
void draw_marker(const PlotPen& pen, int style, double x, double y);

}  // namespace flowskin::tools
