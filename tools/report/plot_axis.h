// The axis of a plot: its range, and ticks at round numbers.
#pragma once

#include <string>
#include <vector>

namespace flowskin::tools {

struct Tick {
  double value = 0;
  std::string label;  ///< Empty: a small tick between the others.
};

struct Axis {
  bool log = false;
  double low = 0, high = 1;  ///< What is at both ends; low < high.
  std::vector<Tick> ticks;   ///< Ascending, all within the range.
  std::string factor;        ///< What all labels are to be multiplied with, such as "×10⁻⁵"; often empty.

  /// True where the axis can show the value.
  bool takes(double value) const;
  /// 0 at the low end, 1 at the high end. @pre takes(value)
  double share(double value) const;
};

/// How the range of an axis follows from the values.
struct AxisWishes {
  bool log = false;
  bool near_zero_from_zero = true;  ///< Begin at zero where the values come near it.
  double margin = 0.04;             ///< Of the range, free at both ends.
  int most_labels = 8;              ///< At least 2.
};

/// Range and ticks for these values; those that are not finite, or cannot be on a logarithmic axis, do not count.
/// Linear ticks are 1, 2 or 5 times a power of ten apart; logarithmic ones are powers of ten, with 2 and 5 where they
/// are few. Without values the range is 0 to 1 (logarithmic: 0.1 to 1).
Axis make_axis(const std::vector<double>& values, const AxisWishes& wishes);

/// Ticks for a given range. @pre low < high, and 0 < low where logarithmic
Axis make_axis(double low, double high, const AxisWishes& wishes);

}  // namespace flowskin::tools
