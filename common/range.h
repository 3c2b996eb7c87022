// The numbers that a setting may be.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace flowskin {

/// Numbers from `min` to `max`; an open end does not belong to the range.
struct Range {
  double min = 0, max = 0;
  bool open_min = false;

  /// False for what is not a number, too.
  constexpr bool holds(double value) const { return (open_min ? value > min : value >= min) && value <= max; }
};
constexpr Range at_least(double min, double max) { return {min, max, false}; }
constexpr Range above(double min, double max) { return {min, max, true}; }

/// One of the numbers of a struct: its name in files, what it may be, and its unit.
template <class Struct>
struct NamedNumber {
  std::string_view name;
  double Struct::*value;
  Range range;
  std::string_view unit;
};

/// The range of one of the numbers of a table; does not compile for one that the table lacks.
template <class Struct, std::size_t count>
consteval Range range_in(const std::array<NamedNumber<Struct>, count>& table, double Struct::*value) {
  for (const NamedNumber<Struct>& number : table) {
    if (number.value == value) return number.range;
  }
  throw "this number is not in the table";
}

}  // namespace flowskin
