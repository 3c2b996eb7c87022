#include "tools/experiments/result_table.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

namespace flowskin::tools {
namespace {

std::string joined(const std::vector<std::string>& words, const std::string& between) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) text += (i ? between : "") + words[i];
  return text;
}

std::string csv_cell(const Cell& cell) {
  if (const auto* number = std::get_if<double>(&cell)) return fmt::format("{}", *number);
  if (const auto* count = std::get_if<int>(&cell)) return fmt::format("{}", *count);
  const std::string& text = std::get<std::string>(cell);
  if (text.find_first_of(",\"\n\r") != std::string::npos) throw std::logic_error("CSV: cannot write \"" + text + "\"");
  return text;
}

std::string markdown_cell(const Cell& cell) {
  if (const auto* number = std::get_if<double>(&cell)) return short_number(*number);
  if (const auto* count = std::get_if<int>(&cell)) return fmt::format("{}", *count);
  return std::get<std::string>(cell);
}

}  // namespace

void ResultTable::add(std::vector<Cell> row) {
  if (row.size() != columns.size())
    throw std::logic_error(fmt::format("a row of {} cells in a table of {} columns", row.size(), columns.size()));
  rows.push_back(std::move(row));
}

std::string ResultTable::csv() const {
  std::string text = joined(columns, ",") + "\n";
  for (const auto& row : rows) {
    std::vector<std::string> cells;
    for (const Cell& cell : row) cells.push_back(csv_cell(cell));
    text += joined(cells, ",") + "\n";
  }
  return text;
}

std::string ResultTable::markdown() const {
  std::string text = "| " + joined(columns, " | ") + " |\n|";
  for (std::size_t i = 0; i < columns.size(); ++i) text += "---|";
  text += "\n";
  for (const auto& row : rows) {
    std::vector<std::string> cells;
    for (const Cell& cell : row) cells.push_back(markdown_cell(cell));
    text += "| " + joined(cells, " | ") + " |\n";
  }
  return text;
}

std::string short_number(double value) { return fmt::format("{:.3g}", value); }

}  // namespace flowskin::tools
