#include "tools/validation/validation_case.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace flowskin::tools {

std::string ValidationFigure::tolerance() const {
  if (is_information()) return "none";
  if (std::isinf(low)) return "<= " + short_number(high);
  if (std::isinf(high)) return ">= " + short_number(low);
  return short_number(low) + " to " + short_number(high);
}

ValidationFigure at_most(std::string what, double measured, double limit) {
  return {std::move(what), measured, -std::numeric_limits<double>::infinity(), limit};
}

ValidationFigure at_least(std::string what, double measured, double limit) {
  return {std::move(what), measured, limit, std::numeric_limits<double>::infinity()};
}

ValidationFigure near_to(std::string what, double measured, double wanted, double tolerance) {
  return {std::move(what), measured, wanted - tolerance, wanted + tolerance};
}

ValidationFigure for_information(std::string what, double measured) {
  ValidationFigure figure;
  figure.what = std::move(what);
  figure.measured = measured;
  return figure;
}

Plot line_plot(std::string title, std::string x_label, std::string y_label, std::vector<Series> series) {
  Plot plot;
  plot.title = std::move(title);
  plot.x_label = std::move(x_label);
  plot.y_label = std::move(y_label);
  plot.series = std::move(series);
  return plot;
}

}  // namespace flowskin::tools
