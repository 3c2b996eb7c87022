#include "scenes/io/text_columns.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "common/number_text.h"
#include "scenes/io/number_words.h"
#include "scenes/io/particle_columns.h"

namespace flowskin::scenes {

TextColumns::TextColumns(const std::vector<std::string>& names) {
  for (const std::string& name : names) columns_.push_back({name, is_id_name(name), {}, {}, {}});
}

void TextColumns::add_cell(Column& column, std::string_view word, std::size_t line_number) const {
  if (column.name.empty()) return;
  const auto value = number_of_word(word);
  if (!value && column.fault.empty())
    column.fault =
        fmt::format("line {}: expected a number as \"{}\", found \"{}\"", line_number, column.name, word.substr(0, 40));
  column.values.push_back(value ? *value : std::nan(""));
  if (!column.is_id || column.ids.size() != rows_) return;
  if (const auto id = whole_number_of_word(word)) column.ids.push_back(*id);
}

std::size_t TextColumns::add_row(std::string_view line, std::size_t line_number) {
  std::size_t k = 0;
  for (std::string_view word = take_word(line); !word.empty(); word = take_word(line), ++k)
    if (k < columns_.size()) add_cell(columns_[k], word, line_number);
  if (k == columns_.size()) ++rows_;
  return k;
}

void TextColumns::move_into(ParticleTable& table) {
  table.count = rows_;
  for (Column& column : columns_) {
    if (column.name.empty() || table.columns.contains(column.name)) continue;
    if (!column.fault.empty()) note_fault(table, column.name, column.fault);
    if (column.is_id && column.ids.size() == rows_) table.ids[column.name] = std::move(column.ids);
    table.columns[column.name] = std::move(column.values);
  }
}

}  // namespace flowskin::scenes
