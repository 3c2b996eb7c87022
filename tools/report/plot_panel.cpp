#include "tools/report/plot_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/report/plot_axis.h"

namespace flowskin::tools {
namespace {

// Pixels.
constexpr double kTitleSize = 13, kLabelSize = 11.5, kTickSize = 10.5, kNoteSize = 9.5;
constexpr double kLegendRow = 18, kLineSample = 30, kBarSample = 11, kLegendGap = 16;
constexpr double kRoomAboveBars = 1.3;  // factor, for their numbers on a logarithmic axis
constexpr double kTickGap = 5;
constexpr double kPixelsALabelX = 62, kPixelsALabelY = 28;

constexpr std::size_t kAllMarked = 15;  // points: with more of them only some are marked
constexpr std::size_t kMarks = 8;

int style_of(const Plot& plot, std::size_t index) {
  return plot.series[index].style >= 0 ? plot.series[index].style : static_cast<int>(index);
}

/// Draws one panel, from the outside inwards.
class Panel {
 public:
  Panel(const PlotPen& pen, const Plot& plot, const PlotBox& box, bool with_legend);
  void draw() const;

 private:
  bool bars() const { return !plot_.categories.empty(); }
  void count_left_out();
  std::vector<double> values_x() const;
  std::vector<double> values_y() const;
  Axis make_y_axis() const;
  std::vector<std::string> notes() const;
  double x_at(double value) const { return area_.x + area_.width * x_axis_.share(value); }
  double y_at(double value) const { return area_.y + area_.height * (1 - y_axis_.share(value)); }
  void draw_axes() const;
  void draw_texts() const;
  void draw_line(std::size_t index) const;
  void draw_marks(std::size_t index) const;
  void draw_bars(std::size_t index) const;

  const PlotPen& pen_;
  const Plot& plot_;
  PlotBox box_, area_;
  PlotLegend legend_;
  Axis x_axis_, y_axis_;
  std::size_t not_positive_ = 0, infinite_ = 0, cut_off_ = 0, drawn_ = 0;
};

Panel::Panel(const PlotPen& pen, const Plot& plot, const PlotBox& box, bool with_legend)
    : pen_(pen), plot_(plot), box_(box), area_(box), legend_(with_legend ? legend_of(plot) : PlotLegend{}) {
  area_.y += plot_.title.empty() ? 8 : kTitleSize + 10;
  if (!legend_.empty()) area_.y += legend_height(pen_, legend_, box_.width, bars()) + 6;
  y_axis_.log = plot_.log_y;
  x_axis_.log = plot_.log_x && !bars();
  count_left_out();
  double bottom = kTickSize + kTickGap + 6;
  if (!plot_.x_label.empty()) bottom += kLabelSize + 6;
  bottom += double(notes().size()) * (kNoteSize + 4);
  area_.height = box_.y + box_.height - bottom - area_.y;
  y_axis_ = make_y_axis();
  if (!y_axis_.factor.empty()) {
    area_.y += kTickSize + 2;
    area_.height -= kTickSize + 2;
  }
  double widest = 0;
  for (const Tick& tick : y_axis_.ticks) widest = std::max(widest, pen_.text_width(tick.label, kTickSize));
  area_.x = box_.x + widest + kTickGap + (plot_.y_label.empty() ? 4 : kLabelSize + 10);
  area_.width = box_.x + box_.width - 14 - area_.x;
  const int labels = static_cast<int>(area_.width / kPixelsALabelX);
  x_axis_ = bars() ? Axis{false, -0.5, double(plot_.categories.size()) - 0.5, {}, {}}
                   : make_axis(values_x(), {plot_.log_x, true, 0.02, labels});
}

void Panel::count_left_out() {
  for (const Series& series : plot_.series) {
    for (std::size_t i = 0; i < series.y.size(); ++i) {
      const double x = bars() ? 1 : series.x[i], y = series.y[i];
      if (std::isnan(x) || std::isnan(y)) continue;
      if (std::isinf(x) || std::isinf(y)) {
        ++infinite_;
      } else if (!x_axis_.takes(x) || !y_axis_.takes(y)) {
        ++not_positive_;
      } else {
        ++drawn_;
        cut_off_ += y < plot_.y_low || y > plot_.y_high;  // NaN: no limit
      }
    }
  }
}

std::vector<double> Panel::values_x() const {
  std::vector<double> values;
  for (const Series& series : plot_.series)
    for (std::size_t i = 0; i < series.x.size(); ++i)
      if (y_axis_.takes(series.y[i])) values.push_back(series.x[i]);
  return values;
}

std::vector<double> Panel::values_y() const {
  std::vector<double> values;
  for (const Series& series : plot_.series)
    for (std::size_t i = 0; i < series.y.size(); ++i)
      if (bars() || x_axis_.takes(series.x[i])) values.push_back(series.y[i]);
  if (bars() && !plot_.log_y) values.push_back(0);
  if (bars() && plot_.log_y && !values.empty())
    values.push_back(kRoomAboveBars * *std::max_element(values.begin(), values.end()));
  return values;
}

Axis Panel::make_y_axis() const {
  const AxisWishes wishes{plot_.log_y, true, 0.06, static_cast<int>(area_.height / kPixelsALabelY)};
  const Axis automatic = make_axis(values_y(), wishes);
  const double low = y_axis_.takes(plot_.y_low) ? plot_.y_low : automatic.low;
  const double high = y_axis_.takes(plot_.y_high) ? plot_.y_high : automatic.high;
  return low < high ? make_axis(low, high, wishes) : automatic;
}

std::vector<std::string> Panel::notes() const {
  std::vector<std::string> lines;
  if (!plot_.note.empty()) lines.push_back(plot_.note);
  const auto add = [&lines](std::size_t count, const char* what) {
    if (count > 0) lines.push_back(fmt::format("{} value{} left out: {}", count, count == 1 ? "" : "s", what));
  };
  add(not_positive_, "not positive, the axis is logarithmic");
  add(infinite_, "infinite");
  add(cut_off_, "beyond the axis");
  return lines;
}

void Panel::draw_axes() const {
  const double bottom = area_.y + area_.height, right = area_.x + area_.width;
  cairo_set_dash(pen_.context(), nullptr, 0, 0);
  for (const Tick& tick : y_axis_.ticks) {
    const double y = y_at(tick.value);
    pen_.color(kPlotGrid);
    if (!tick.label.empty()) pen_.line(area_.x, y, right, y, 1);
    pen_.color(kPlotPaleInk);
    if (tick.label.empty()) pen_.line(area_.x - 2, y, area_.x, y, 0.8);
    pen_.text(area_.x - kTickGap, y + 0.36 * kTickSize, kTickSize, tick.label, Align::right);
  }
  for (const Tick& tick : x_axis_.ticks) {
    const double x = x_at(tick.value);
    pen_.color(kPlotGrid);
    if (!tick.label.empty()) pen_.line(x, area_.y, x, bottom, 1);
    pen_.color(kPlotPaleInk);
    pen_.line(x, bottom, x, bottom + (tick.label.empty() ? 2 : 4), 0.8);
    pen_.text(x, bottom + kTickGap + kTickSize, kTickSize, tick.label, Align::center);
  }
  pen_.color(kPlotPaleInk);
  for (std::size_t i = 0; i < plot_.categories.size(); ++i)
    pen_.text(x_at(double(i)), bottom + kTickGap + kTickSize, kTickSize, plot_.categories[i], Align::center);
  pen_.line(area_.x, bottom, right, bottom, 1);
  pen_.line(area_.x, area_.y, area_.x, bottom, 1);
  if (bars() && y_axis_.takes(0) && y_axis_.low < 0) pen_.line(area_.x, y_at(0), right, y_at(0), 1);
}

void Panel::draw_texts() const {
  const double bottom = area_.y + area_.height, middle = area_.x + 0.5 * area_.width;
  pen_.color(kPlotInk);
  pen_.text(box_.x + 2, box_.y + kTitleSize, kTitleSize, plot_.title, Align::left, true);
  pen_.text_upwards(box_.x + kLabelSize, area_.y + 0.5 * area_.height, kLabelSize, plot_.y_label);
  double y = bottom + kTickGap + kTickSize;
  if (!plot_.x_label.empty()) pen_.text(middle, y += kLabelSize + 6, kLabelSize, plot_.x_label, Align::center);
  pen_.color(kPlotPaleInk);
  if (!y_axis_.factor.empty()) pen_.text(area_.x, area_.y - 4, kTickSize, y_axis_.factor, Align::left);
  if (!x_axis_.factor.empty())
    pen_.text(area_.x + area_.width, bottom + 2 * kTickSize + kTickGap + 4, kTickSize, x_axis_.factor, Align::right);
  for (const std::string& note : notes()) pen_.text(area_.x, y += kNoteSize + 4, kNoteSize, note, Align::left);
  if (drawn_ == 0) pen_.text(middle, area_.y + 0.5 * area_.height, kLabelSize, "no values to show", Align::center);
}

void Panel::draw_line(std::size_t index) const {
  const Series& series = plot_.series[index];
  use_line_style(pen_, style_of(plot_, index));
  bool drawing = false;
  for (std::size_t i = 0; i < series.y.size(); ++i) {
    if (!x_axis_.takes(series.x[i]) || !y_axis_.takes(series.y[i])) {
      drawing = false;
      continue;
    }
    const double x = x_at(series.x[i]), y = y_at(series.y[i]);
    if (drawing) {
      cairo_line_to(pen_.context(), x, y);
    } else {
      cairo_move_to(pen_.context(), x, y);
    }
    drawing = true;
  }
  cairo_stroke(pen_.context());
}

/// Of many points, some are marked: spread evenly, those of different lines beside each other.
void Panel::draw_marks(std::size_t index) const {
  const Series& series = plot_.series[index];
  const std::size_t count = series.y.size();
  const std::size_t every = count > kAllMarked ? count / kMarks : 1;
  const std::size_t first = index * every / std::max<std::size_t>(1, plot_.series.size());
  const auto shown = [&](std::size_t i) {
    return i < count && x_axis_.takes(series.x[i]) && y_axis_.takes(series.y[i]);
  };
  for (std::size_t i = 0; i < count; ++i) {
    const bool alone = shown(i) && !(i > 0 && shown(i - 1)) && !shown(i + 1);
    if (!shown(i) || (i % every != first % every && !alone)) continue;
    const double share = y_axis_.share(series.y[i]);
    if (share >= -1e-9 && share <= 1 + 1e-9)
      draw_marker(pen_, style_of(plot_, index), x_at(series.x[i]), y_at(series.y[i]));
  }
}

void Panel::draw_bars(std::size_t index) const {
  const Series& series = plot_.series[index];
  const double group = area_.width / double(plot_.categories.size());
  const double width = 0.8 * group / double(plot_.series.size());
  const double base = y_axis_.takes(0) ? y_at(std::clamp(0.0, y_axis_.low, y_axis_.high)) : area_.y + area_.height;
  for (std::size_t i = 0; i < std::min(series.y.size(), plot_.categories.size()); ++i) {
    if (!y_axis_.takes(series.y[i])) continue;
    const double left = x_at(double(i)) - 0.4 * group + width * double(index);
    const double top = y_at(series.y[i]);
    pen_.color(style_color(style_of(plot_, index)));
    cairo_rectangle(pen_.context(), left + 0.5, std::min(top, base), std::max(1.0, width - 1), std::abs(base - top));
    cairo_fill(pen_.context());
    const std::string text = fmt::format("{:.2g}", series.y[i]);
    if (pen_.text_width(text, kNoteSize) > width + 2) continue;
    pen_.color(kPlotPaleInk);
    pen_.text(left + 0.5 * width, top < base ? top - 3 : top + kNoteSize + 2, kNoteSize, text, Align::center);
  }
}

void Panel::draw() const {
  draw_axes();
  cairo_save(pen_.context());
  cairo_rectangle(pen_.context(), area_.x, area_.y - 1, area_.width, area_.height + 2);
  cairo_clip(pen_.context());
  for (std::size_t i = 0; i < plot_.series.size(); ++i) {
    if (bars()) {
      draw_bars(i);
    } else {
      draw_line(i);
    }
  }
  cairo_restore(pen_.context());
  for (std::size_t i = 0; !bars() && i < plot_.series.size(); ++i) draw_marks(i);
  draw_texts();
  const double top = box_.y + (plot_.title.empty() ? 4 : kTitleSize + 6);
  draw_legend(pen_, legend_, {box_.x, top, box_.width, 0}, bars());
}

double sample_width(bool bars) { return bars ? kBarSample : kLineSample; }

/// Calls place(entry, x, row) for each entry. @return the number of rows
template <class Place>
int lay_out_legend(const PlotPen& pen, const PlotLegend& legend, double width, double sample, const Place& place) {
  double x = 0;
  int row = 0;
  for (const auto& entry : legend) {
    const double needed = sample + 6 + pen.text_width(entry.first, kTickSize);
    if (x > 0 && x + needed > width) {
      x = 0;
      ++row;
    }
    place(entry, x, row);
    x += needed + kLegendGap;
  }
  return legend.empty() ? 0 : row + 1;
}

}  // namespace

PlotLegend legend_of(const Plot& plot) {
  PlotLegend legend;
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    if (!plot.series[i].name.empty()) legend.emplace_back(plot.series[i].name, style_of(plot, i));
  }
  return legend;
}

double legend_height(const PlotPen& pen, const PlotLegend& legend, double width, bool bars) {
  return kLegendRow * lay_out_legend(pen, legend, width, sample_width(bars), [](const auto&, double, int) {});
}

void draw_legend(const PlotPen& pen, const PlotLegend& legend, const PlotBox& box, bool bars) {
  const double sample = sample_width(bars);
  lay_out_legend(pen, legend, box.width, sample, [&](const auto& entry, double at, int row) {
    const double x = box.x + 2 + at, y = box.y + kLegendRow * (row + 0.5);
    if (bars) {
      pen.color(style_color(entry.second));
      cairo_rectangle(pen.context(), x, y - 0.5 * sample, sample, sample);
      cairo_fill(pen.context());
    } else {
      use_line_style(pen, entry.second);
      cairo_move_to(pen.context(), x, y);
      cairo_line_to(pen.context(), x + sample, y);
      cairo_stroke(pen.context());
      draw_marker(pen, entry.second, x + 0.5 * sample, y);
    }
    pen.color(kPlotInk);
    pen.text(x + sample + 6, y + 0.36 * kTickSize, kTickSize, entry.first, Align::left);
  });
}

void draw_panel(const PlotPen& pen, const Plot& plot, const PlotBox& box, bool with_legend) {
  Panel(pen, plot, box, with_legend).draw();
}

}  // namespace flowskin::tools
