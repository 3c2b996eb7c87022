// Runs validations and reports them: a table on the terminal, CSV files and plots in a folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/validation/validation_case.h"

namespace flowskin::tools {

/// What the command line says.
struct ValidateOptions {
  std::vector<std::string> names;  ///< Cases; empty: all.
  std::filesystem::path out = "output/validation";
  double resolution = 1;  ///< Factor on the particles along each length.
  int threads = 0;        ///< 0: as many as the machine has
  bool quick = false;     ///< Without the long cases.
  bool list = false;      ///< Only names and titles.
  bool quiet = false;     ///< The table only.
};

/// A case that has run.
struct ValidationOutcome {
  std::string name;
  ValidationResult result;
  double seconds = 0;
  std::string failure;  ///< Why it could not be computed to its end; empty: it was.

  bool holds() const;
};

/// Runs one case; a solver that blows up is an outcome, not an exception.
ValidationOutcome run_case(const ValidationCase& one, double resolution);

/// Columns case, figure, tolerance, measured, verdict, seconds.
ResultTable outcome_table(const std::vector<ValidationOutcome>& outcomes);
/// The same as aligned text for a terminal.
std::string outcome_text(const std::vector<ValidationOutcome>& outcomes);

/// Writes <case>.csv, .svg and .png of an outcome into a folder that exists.
/// @throws RunError where a file cannot be written
void write_outcome(const ValidationOutcome& outcome, const std::filesystem::path& folder);

/// Runs the cases, prints the table, writes all files and validation.csv and validation.md.
/// @returns whether all figures lie within their limits
/// @throws InputError for unknown names; RunError where files cannot be written
bool run_validation(const ValidateOptions& options);

}  // namespace flowskin::tools
