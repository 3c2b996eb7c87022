// The numbers that a setting may be.
#pragma once

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

}  // namespace flowskin
