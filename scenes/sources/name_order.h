// The order of files by the numbers in their names, whatever program wrote them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace flowskin::scenes {

/// Names in the order of their numbers.
struct NameOrder {
  std::vector<std::size_t> order;  ///< Which name is first, second, ...
  /// The number of each name, in that order; empty where no one number tells the order.
  std::vector<double> numbers;
  /// The same where all are whole and can be counted with.
  std::vector<std::int64_t> counts;
  bool looks_like_times = false;  ///< Decimals or exponents are in the names.
  bool is_clock = false;          ///< The numbers are a date or a time of day.
  /// How the names were read, where they can be read in more than one way; empty where there is but one.
  std::string note;
  /// Two names (by index) with the same number.
  std::optional<std::pair<std::size_t, std::size_t>> twins;
};

/// The names differ in one number: digits with or without sign, decimals and exponent. A minus after a letter or digit
/// parts the name from the number, unless only some names have it. Where decimals are as likely counters (run1.9,
/// run1.10), what gives even steps counts. Where several numbers differ, the one that counts evenly, else the first.
/// Where the names differ in letters, the order is natural: numbers as numbers, the rest letter by letter.
NameOrder order_of_names(const std::vector<std::string>& names);

/// Where numbers in ascending order lie on an even raster.
struct Raster {
  double stride = 0;                 ///< 0: there is none
  std::vector<std::uint64_t> steps;  ///< Of each number, in strides from the first.
  std::uint64_t missing = 0;         ///< Places of the raster that no number takes.
  std::size_t before_gap = 0;        ///< Index of the last number before the first of them.
  bool is_regular = false;           ///< Few places are missing for so many numbers.
};
Raster raster_of(const NameOrder& names);

}  // namespace flowskin::scenes
