// The words for the values of an enumeration, as data: one table an enumeration, beside it.
#pragma once

#include <iterator>
#include <optional>
#include <string>
#include <string_view>

namespace flowskin {

/// A value and the word that stands for it in files and messages.
template <class Value>
struct NamedValue {
  std::string_view name;
  Value value;
};

/// The word for a value; empty where the table has none.
template <class Table, class Value>
constexpr std::string_view name_of(const Table& table, Value value) {
  for (const auto& entry : table) {
    if (entry.value == value) return entry.name;
  }
  return {};
}

/// The value that a word stands for; none where the table does not have the word.
template <class Table>
constexpr auto value_named(const Table& table, std::string_view name)
    -> std::optional<decltype(std::begin(table)->value)> {
  for (const auto& entry : table) {
    if (entry.name == name) return entry.value;
  }
  return std::nullopt;
}

/// All words of a table, for messages: "a, b or c".
template <class Table>
std::string names_in_words(const Table& table) {
  std::string words;
  for (auto entry = std::begin(table); entry != std::end(table); ++entry) {
    if (entry != std::begin(table)) words += std::next(entry) == std::end(table) ? " or " : ", ";
    words += entry->name;
  }
  return words;
}

}  // namespace flowskin
