#include "tools/report/plot_axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace flowskin::tools {
namespace {

constexpr double kFromZeroBelow = 0.5;  // share of the largest value: an axis whose values begin there shows zero
constexpr double kRounding = 1e-9;      // of a step
constexpr int kPlainLow = -4, kPlainHigh = 5;               // exponents of numbers that are written out
constexpr double kPlainLogLow = 1e-3, kPlainLogHigh = 1e4;  // a logarithmic axis within these has no powers of ten

std::string superscript(int number) {
  static const char* const digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = number < 0 ? "⁻" : "";
  for (const char digit : std::to_string(std::abs(number))) text += digits[digit - '0'];
  return text;
}

int exponent_of(double value) { return static_cast<int>(std::floor(std::log10(value) + kRounding)); }

/// 1, 2 or 5 times a power of ten: the smallest such number that is at least `value`.
double round_up(double value) {
  const double power = std::pow(10.0, exponent_of(value));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (digit * power >= value * (1 - kRounding)) return digit * power;
  }
  return 10 * power;
}

double round_down(double value) {
  const double power = std::pow(10.0, exponent_of(value));
  for (const double digit : {5.0, 2.0}) {
    if (digit * power <= value * (1 + kRounding)) return digit * power;
  }
  return power;
}

/// Typographic minus, and no minus before zero.
std::string signed_text(std::string text) {
  if (text.starts_with('-')) {
    text.erase(0, 1);
    if (text.find_first_not_of("0.") != std::string::npos) text.insert(0, "−");
  }
  return text;
}

void add_linear_ticks(Axis& axis, int most_labels) {
  double step = round_up((axis.high - axis.low) / most_labels);
  const double largest = std::max(std::abs(axis.low), std::abs(axis.high));
  int power = exponent_of(largest);
  if (power > kPlainLow && power < kPlainHigh) power = 0;
  if (power != 0) axis.factor = "×10" + superscript(power);
  const double unit = std::pow(10.0, power);
  const int decimals = std::max(0, power - exponent_of(step));
  const double first = std::ceil(axis.low / step - kRounding), last = std::floor(axis.high / step + kRounding);
  for (double k = first; k <= last; ++k) {
    axis.ticks.push_back({k * step, signed_text(fmt::format("{:.{}f}", k * step / unit, decimals))});
  }
}

std::string log_label(int digit, int exponent, bool plain) {
  if (plain || (digit == 1 && exponent == 0))
    return fmt::format("{:.{}f}", digit * std::pow(10.0, exponent), std::max(0, -exponent));
  const std::string power = "10" + superscript(exponent);
  return digit == 1 ? power : fmt::format("{}·{}", digit, power);
}

void add_log_ticks(Axis& axis, int most_labels) {
  const int first = exponent_of(axis.low), last = exponent_of(axis.high);
  const double decades = std::log10(axis.high / axis.low);
  const bool label_digits = 3 * decades <= most_labels;
  const bool plain = axis.low >= kPlainLogLow * (1 - kRounding) && axis.high <= kPlainLogHigh * (1 + kRounding);
  const int every = std::max(1, static_cast<int>(std::ceil(decades / most_labels)));
  for (int exponent = first; exponent <= last; ++exponent) {
    for (int digit = 1; digit <= 9; ++digit) {
      const double value = digit * std::pow(10.0, exponent);
      if (value < axis.low * (1 - kRounding) || value > axis.high * (1 + kRounding)) continue;
      const bool whole = digit == 1 && exponent % every == 0;
      const bool part = label_digits && (digit == 1 || digit == 2 || digit == 5);
      if (whole || part) {
        axis.ticks.push_back({value, log_label(digit, exponent, plain)});
      } else if (every == 1 || digit == 1) {
        axis.ticks.push_back({value, ""});
      }
    }
  }
}

Axis with_ticks(bool log, double low, double high, int most_labels) {
  Axis axis{log, low, high, {}, {}};
  if (log) {
    add_log_ticks(axis, most_labels);
  } else {
    add_linear_ticks(axis, most_labels);
  }
  return axis;
}

}  // namespace

bool Axis::takes(double value) const { return std::isfinite(value) && (!log || value > 0); }

double Axis::share(double value) const {
  return log ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
}

Axis make_axis(double low, double high, const AxisWishes& wishes) {
  return with_ticks(wishes.log, low, high, std::max(2, wishes.most_labels));
}

Axis make_axis(const std::vector<double>& values, const AxisWishes& wishes) {
  const Axis probe{wishes.log, 0, 1, {}, {}};
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double value : values) {
    if (!probe.takes(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (wishes.log) {
    if (low > high) return make_axis(0.1, 1, wishes);
    low = round_down(low);
    high = round_up(high);
    if (high < 5 * low) {
      low = round_down(low * 0.9);
      high = round_up(high * 1.1);
    }
    return make_axis(low, high, wishes);
  }
  if (low > high) return make_axis(0, 1, wishes);
  if (low == high) {
    const double half = low == 0 ? 1 : 0.5 * std::abs(low);
    return make_axis(low - half, high + half, wishes);
  }
  const bool zero_low = wishes.near_zero_from_zero && low >= 0 && low <= kFromZeroBelow * high;
  const bool zero_high = wishes.near_zero_from_zero && high <= 0 && high >= kFromZeroBelow * low;
  const double margin = wishes.margin * (high - low);
  return make_axis(zero_low ? 0 : low - margin, zero_high ? 0 : high + margin, wishes);
}

}  // namespace flowskin::tools
