#include "scenes/io/number_words.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>

#include "common/number_text.h"

namespace flowskin::scenes {
namespace {

constexpr std::size_t longest_number = 400;

std::string in_small_letters(std::string_view word) {
  std::string small(word);
  std::transform(small.begin(), small.end(), small.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return small;
}

/// nan, -nan(ind), 1.#qnan, -1.#ind, inf, 1.#inf, infinity, in small letters and without sign.
std::optional<double> no_number(std::string_view word) {
  if (word.starts_with("1.#")) word.remove_prefix(3);
  if (word.starts_with("qnan") || word.starts_with("snan")) word.remove_prefix(1);
  if (word == "nan" || word.starts_with("nan(") || word.starts_with("ind"))
    return std::numeric_limits<double>::quiet_NaN();
  if (word == "inf" || word == "infinity") return std::numeric_limits<double>::infinity();
  return std::nullopt;
}

/// A number with the exponent written as C does, all of the text.
std::optional<double> plain_number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc::invalid_argument || end != text.data() + text.size() || text.empty()) return std::nullopt;
  if (error == std::errc()) return value;
  const bool negative = text.starts_with('-');
  const std::size_t exponent = text.find_first_of("eE");
  const std::size_t first = text.find_first_of("123456789");
  const bool large = exponent != std::string_view::npos ? text.substr(exponent + 1, 1) != "-"
                                                        : first < std::min(text.find('.'), text.size());
  const double size = large ? std::numeric_limits<double>::infinity() : 0.0;
  return negative ? -size : size;
}

}  // namespace

std::optional<double> number_of_word(std::string_view word) {
  if (word.starts_with('+') && word.size() > 1 && word[1] != '-') word.remove_prefix(1);
  if (word.empty() || word.size() > longest_number) return std::nullopt;
  if (const auto value = plain_number(word)) return value;
  std::string text = in_small_letters(word);
  const bool negative = text.starts_with('-');
  if (const auto value = no_number(std::string_view(text).substr(negative ? 1 : 0))) return negative ? -*value : *value;
  std::replace(text.begin(), text.end(), 'd', 'e');
  std::size_t sign = text.find_last_of("+-");
  if (sign == std::string::npos || sign == 0) return plain_number(text);
  if (text[sign] == '+') {
    text.erase(sign, 1);
    --sign;
    if (text[sign] != 'e') text.insert(sign + 1, 1, 'e');
  } else if (text[sign - 1] != 'e') {
    text.insert(sign, 1, 'e');  // 0.1234-100
  }
  return plain_number(text);
}

std::optional<double> number_with_comma(std::string_view word) {
  const std::size_t comma = word.find(',');
  if (comma == std::string_view::npos || word.find('.') != std::string_view::npos || word.size() > longest_number)
    return number_of_word(word);
  std::string text(word);
  text[comma] = '.';
  return number_of_word(text);
}

bool take_number_word(std::string_view& text, double& value) {
  const auto ends = [](std::string_view rest) {
    return rest.empty() || std::string_view(" \t\r\n").find(rest.front()) != std::string_view::npos;
  };
  std::string_view rest = text;
  if (take_number(rest, value) && ends(rest)) {
    text = rest;
    return true;
  }
  rest = text;
  const auto number = ends(text) ? std::nullopt : number_of_word(take_word(rest));
  if (!number) return false;
  value = *number;
  text = rest;
  return true;
}

std::optional<std::uint64_t> whole_number_of_word(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const char* const end = word.data() + word.size();
  std::uint64_t large = 0;
  if (const auto result = std::from_chars(word.data(), end, large); result.ec == std::errc() && result.ptr == end)
    return large;
  std::int64_t small = 0;
  if (const auto result = std::from_chars(word.data(), end, small); result.ec == std::errc() && result.ptr == end)
    return static_cast<std::uint64_t>(small);
  const auto value = number_of_word(word);
  return value ? whole_number_of(*value) : std::nullopt;
}

std::optional<std::uint64_t> whole_number_of(double value) {
  constexpr double largest_exact = 9007199254740992.0;  // 2^53
  if (!(std::abs(value) <= largest_exact) || value != std::floor(value)) return std::nullopt;
  return static_cast<std::uint64_t>(static_cast<std::int64_t>(value));
}

}  // namespace flowskin::scenes
