// Rows of numbers as the text of a CSV file.
#pragma once

#include <fmt/format.h>

#include <iterator>
#include <string>
#include <vector>

namespace flowskin::tools {

/// A header and one line per row. `for_each_column(row, visit)` calls visit(name, value) for each column, so that
/// header and rows cannot disagree.
template <class Row, class ForEachColumn>
std::string csv_text(const std::vector<Row>& rows, const ForEachColumn& for_each_column) {
  std::string text;
  for_each_column(Row{},
                  [&](const char* name, const auto&) { text += fmt::format("{}{}", text.empty() ? "" : ",", name); });
  text += '\n';
  for (const Row& row : rows) {
    bool first = true;
    for_each_column(row, [&](const char*, const auto& value) {
      if (!first) text += ',';
      first = false;
      fmt::format_to(std::back_inserter(text), "{}", value);
    });
    text += '\n';
  }
  return text;
}

}  // namespace flowskin::tools
