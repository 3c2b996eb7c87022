// Numbers as text and back, whatever the locale.
#pragma once

#include <array>
#include <charconv>
#include <string>
#include <string_view>
#include <system_error>

namespace flowskin {

/// The shortest text that gives the number back when read.
template <class Number>
std::string number_text(Number value) {
  std::array<char, 32> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}
/// The number with so many significant digits, for messages.
inline std::string number_text(double value, int digits) {
  std::array<char, 32> text;
  return {text.data(),
          std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, digits).ptr};
}

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

}  // namespace flowskin
