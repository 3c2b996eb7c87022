// Numbers of an experiment: as CSV with all their digits, as Markdown with three.
#pragma once

#include <string>
#include <variant>
#include <vector>

namespace flowskin::tools {

using Cell = std::variant<std::string, int, double>;

struct ResultTable {
  std::vector<std::string> columns;
  std::vector<std::vector<Cell>> rows;

  /// @throws std::logic_error where the row has not one cell per column.
  void add(std::vector<Cell> row);
  /// Comma separated, one header line; numbers read back to the same value, "nan" and "inf" for those.
  /// @throws std::logic_error where a text holds a comma, a quote or a line break.
  std::string csv() const;
  std::string markdown() const;
};

/// Three significant digits: "0.00123", "1.2e-08".
std::string short_number(double value);

}  // namespace flowskin::tools
