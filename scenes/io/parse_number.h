// Numbers from text, whatever the locale.
#pragma once

#include <charconv>
#include <string_view>
#include <system_error>

namespace flowskin::scenes {

/// Reads a number at the start of `text` and removes it; false, and `text` untouched, where there is none.
/// A leading + is allowed, as C's readers do. A number beyond the range of double counts as none.
inline bool take_number(std::string_view& text, double& value) {
  const std::string_view digits = !text.empty() && text.front() == '+' ? text.substr(1) : text;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc()) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return true;
}

/// Removes white space at the start of `text`; `spaces` says which characters count.
inline void skip_space(std::string_view& text, std::string_view spaces = " \t\r\n") {
  const std::size_t start = text.find_first_not_of(spaces);
  text.remove_prefix(start == std::string_view::npos ? text.size() : start);
}

/// Removes and returns the characters up to the next white space; empty at the end.
inline std::string_view take_word(std::string_view& text) {
  skip_space(text);
  const std::string_view word = text.substr(0, text.find_first_of(" \t\r\n"));
  text.remove_prefix(word.size());
  return word;
}

}  // namespace flowskin::scenes
