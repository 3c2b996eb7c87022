// A validation of the fluid: one flow computed and set beside theory or experiment.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "tools/experiments/result_table.h"
#include "tools/report/plot.h"

namespace flowskin::tools {

/// One number that must lie between two limits.
struct ValidationFigure {
  std::string what;     ///< In words, with the unit: "largest error of the pressure (share of the greatest)".
  double measured = 0;  ///< NaN fails.
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();

  bool holds() const { return measured >= low && measured <= high; }
  /// Without limits: it tells something and is not judged.
  bool is_information() const { return low == -high && high == std::numeric_limits<double>::infinity(); }
  /// "<= 0.02", "0.115 to 0.135", ">= 1.5", "none"
  std::string tolerance() const;
};

/// measured <= limit
ValidationFigure at_most(std::string what, double measured, double limit);
/// measured >= limit
ValidationFigure at_least(std::string what, double measured, double limit);
/// |measured - wanted| <= tolerance
ValidationFigure near_to(std::string what, double measured, double wanted, double tolerance);
/// No verdict: what helps to understand the other figures.
ValidationFigure for_information(std::string what, double measured);

/// A panel of lines.
Plot line_plot(std::string title, std::string x_label, std::string y_label, std::vector<Series> series);

/// What a case hands back.
struct ValidationResult {
  std::vector<ValidationFigure> figures;
  ResultTable data;  ///< Computed and reference values, for <case>.csv.
  PlotSheet plots;   ///< Computed against reference, for <case>.svg and .png; no panel: no plot.
};

/// A case: a file in tools/validation/cases/ and a line in registry.cpp.
struct ValidationCase {
  std::string name;   ///< Word of the command line, such as dam_break.
  std::string title;  ///< A line: what flow, against what.
  bool quick = true;  ///< Some seconds on one core: part of the ordinary tests.
  /// Computes the flow. `resolution` multiplies the particles along each length (1: as validated). Deterministic.
  std::function<ValidationResult(double resolution)> run;
};

/// All cases, in the order in which they run.
const std::vector<ValidationCase>& validation_cases();
/// @throws InputError with the known names (and the nearest) where there is none of this name.
const ValidationCase& validation_case(const std::string& name);

}  // namespace flowskin::tools
