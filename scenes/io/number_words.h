// Numbers as programs of all kinds write them into text files.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace flowskin::scenes {

/// The number that a whole word stands for: also with a D exponent or one without letter (Fortran), below the range of
/// doubles (0) or above it (infinite), NaN and infinity in the spellings of all C libraries (-1.#IND, nan(ind), Inf).
std::optional<double> number_of_word(std::string_view word);
/// The same where a comma stands for the decimal point.
std::optional<double> number_with_comma(std::string_view word);

/// Reads a number that white space or the end follows, and removes it; false, and `text` untouched, where there is
/// none.
bool take_number_word(std::string_view& text, double& value);

/// A whole number of 64 bits, signed or not, as its bits; empty where the word is none.
std::optional<std::uint64_t> whole_number_of_word(std::string_view word);
/// The same from a double: whole, and so small that doubles next to it are whole numbers next to it.
std::optional<std::uint64_t> whole_number_of(double value);

}  // namespace flowskin::scenes
