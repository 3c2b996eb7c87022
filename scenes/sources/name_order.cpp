#include "scenes/sources/name_order.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "common/number_text.h"

namespace flowskin::scenes {
namespace {

/// Numbers with more places missing than this many per number are no frame numbers, unless most are neighbours.
constexpr std::uint64_t most_steps_per_number = 4;
/// The same where most are neighbours: more is a date, or a number of another kind.
constexpr std::uint64_t most_steps_per_neighbor = 30;
/// Of a stride, by which decimals may be off an even raster: names hold them rounded.
constexpr double raster_tolerance = 1e-3;
/// Of a whole number that can be counted with.
constexpr std::size_t most_digits = 18;

/// How names can be read.
struct Reading {
  bool decimals = true;            ///< 1.5 is one number.
  bool unsigned_exponents = true;  ///< 1e5 is one number; 1e-5 always is.
  bool sign_after_letters = false;
};
/// The likeliest first.
constexpr Reading readings[] = {{}, {true, true, true}, {true, false, false}, {false, false, false}};

bool is_decimal_digit(char c) { return c >= '0' && c <= '9'; }
bool is_name_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c & 0x80) != 0; }

/// A number as it is written, for exact comparisons.
struct Number {
  std::string text;
  bool negative = false, has_exponent = false;
  std::string whole,
      fraction;  ///< Digits before the point, without leading zeros, and after it, without trailing ones.
  double value = 0;
  bool is_whole() const { return fraction.empty() && !has_exponent; }
};

/// A name as text and numbers in turn, text first.
struct Parts {
  std::vector<std::string> texts;
  std::vector<Number> numbers;
};

std::size_t end_of_digits(const std::string& name, std::size_t at) {
  while (at < name.size() && is_decimal_digit(name[at])) ++at;
  return at;
}

/// End of the exponent that starts at `at`; `at` where there is none.
std::size_t end_of_exponent(const std::string& name, std::size_t at, bool unsigned_too) {
  if (at >= name.size() || (name[at] != 'e' && name[at] != 'E')) return at;
  std::size_t digits = at + 1;
  const bool is_signed = digits < name.size() && (name[digits] == '-' || name[digits] == '+');
  if (is_signed) ++digits;
  const std::size_t end = end_of_digits(name, digits);
  const bool goes_on = end < name.size() && is_name_letter(name[end]);
  return end > digits && !goes_on && (is_signed || unsigned_too) ? end : at;
}

bool is_point(const std::string& name, std::size_t at) {
  return at + 1 < name.size() && (name[at] == '.' || name[at] == ',') && is_decimal_digit(name[at + 1]);
}

/// The number from `start` (its sign or first digit) to the end that is set.
Number take_number_at(const std::string& name, std::size_t start, std::size_t& end, const Reading& reading) {
  Number number;
  std::size_t at = start;
  number.negative = name[at] == '-';
  if (name[at] == '-' || name[at] == '+') ++at;
  std::size_t whole_end = end_of_digits(name, at);
  number.whole = name.substr(at, whole_end - at);
  end = whole_end;
  if (reading.decimals && is_point(name, whole_end)) {
    end = end_of_digits(name, whole_end + 1);
    number.fraction = name.substr(whole_end + 1, end - whole_end - 1);
  }
  const std::size_t exponent_end = end_of_exponent(name, end, reading.unsigned_exponents);
  number.has_exponent = exponent_end > end;
  end = exponent_end;
  number.text = name.substr(start, end - start);
  std::string plain = number.text;
  std::replace(plain.begin(), plain.end(), ',', '.');
  std::string_view rest = plain;
  if (!take_number(rest, number.value)) number.value = number.negative ? -HUGE_VAL : HUGE_VAL;
  number.whole.erase(0, std::min(number.whole.find_first_not_of('0'), number.whole.size()));
  while (number.fraction.ends_with('0')) number.fraction.pop_back();
  if (number.whole.empty() && number.fraction.empty()) number.negative = false;
  return number;
}

/// Whether a sign may stand at `at`, before a digit.
bool is_sign(const std::string& name, std::size_t at, const Reading& reading) {
  if ((name[at] != '-' && name[at] != '+') || at + 1 >= name.size() || !is_decimal_digit(name[at + 1])) return false;
  if (at == 0) return true;
  const char before = name[at - 1];
  return reading.sign_after_letters ? !is_decimal_digit(before)
                                    : !is_decimal_digit(before) && !is_name_letter(before) && before != ')';
}

Parts parts_of(const std::string& name, const Reading& reading) {
  Parts parts;
  parts.texts.emplace_back();
  for (std::size_t i = 0; i < name.size();) {
    if (!is_decimal_digit(name[i]) && !is_sign(name, i, reading)) {
      parts.texts.back() += name[i++];
      continue;
    }
    std::size_t end = i;
    parts.numbers.push_back(take_number_at(name, i, end, reading));
    parts.texts.emplace_back();
    i = end;
  }
  return parts;
}

int sign_of(bool less, bool greater) { return less ? -1 : greater ? 1 : 0; }

int compare_size(const Number& a, const Number& b) {
  if (a.has_exponent || b.has_exponent)
    return sign_of(std::abs(a.value) < std::abs(b.value), std::abs(a.value) > std::abs(b.value));
  if (a.whole.size() != b.whole.size()) return a.whole.size() < b.whole.size() ? -1 : 1;
  if (a.whole != b.whole) return a.whole < b.whole ? -1 : 1;
  return sign_of(a.fraction < b.fraction, b.fraction < a.fraction);
}

int compare(const Number& a, const Number& b) {
  if (a.negative != b.negative) return a.negative ? -1 : 1;
  return a.negative ? compare_size(b, a) : compare_size(a, b);
}

int compare(const Parts& a, const Parts& b) {
  for (std::size_t i = 0;; ++i) {
    if (i >= a.texts.size() || i >= b.texts.size())
      return sign_of(a.texts.size() < b.texts.size(), b.texts.size() < a.texts.size());
    if (a.texts[i] != b.texts[i]) return a.texts[i] < b.texts[i] ? -1 : 1;
    if (i >= a.numbers.size() || i >= b.numbers.size()) continue;
    if (const int order = compare(a.numbers[i], b.numbers[i])) return order;
  }
}

/// All names in one reading.
struct Candidate {
  std::vector<Parts> names;
  bool same_texts = true;
  std::vector<std::size_t> varying;   ///< Numbers that differ from name to name.
  std::optional<std::size_t> chosen;  ///< The one that tells the order.
  Raster raster;                      ///< Of it.
  int rank = 3;                       ///< 0: one number on a raster, 1: one number, 2: several, 3: letters differ
};

std::vector<std::size_t> sorted_by(const Candidate& candidate, std::optional<std::size_t> column) {
  std::vector<std::size_t> order(candidate.names.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const Parts &x = candidate.names[a], &y = candidate.names[b];
    return (column ? compare(x.numbers[*column], y.numbers[*column]) : compare(x, y)) < 0;
  });
  return order;
}

/// The numbers of one column in ascending order; without `counts` where they are not whole.
NameOrder numbers_in_order(const Candidate& candidate, std::size_t column) {
  NameOrder result;
  result.order = sorted_by(candidate, column);
  bool whole = true;
  for (const std::size_t i : result.order) {
    const Number& number = candidate.names[i].numbers[column];
    whole = whole && number.is_whole() && number.whole.size() <= most_digits;
    result.looks_like_times = result.looks_like_times || number.has_exponent || !number.fraction.empty();
    result.numbers.push_back(number.value);
  }
  if (!whole) return result;
  for (const std::size_t i : result.order) {
    const Number& number = candidate.names[i].numbers[column];
    const std::int64_t size = number.whole.empty() ? 0 : std::stoll(number.whole);
    result.counts.push_back(number.negative ? -size : size);
  }
  return result;
}

bool all_differ(const Candidate& candidate, std::size_t column) {
  const std::vector<std::size_t> order = sorted_by(candidate, column);
  return std::adjacent_find(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
           return compare(candidate.names[a].numbers[column], candidate.names[b].numbers[column]) == 0;
         }) == order.end();
}

/// Digits after a point with leading zeros in some names only are decimals, no counter.
bool can_be_counter(const Candidate& candidate, std::size_t column) {
  bool padded = false, same_width = true;
  const std::size_t width = candidate.names.front().numbers[column].text.size();
  for (const Parts& name : candidate.names) {
    const std::string& text = name.numbers[column].text;
    padded = padded || (text.size() > 1 && text.starts_with('0'));
    same_width = same_width && text.size() == width;
  }
  return same_width || !padded;
}

/// Date and clock: numbers of two digits (the year of four) one after the other, the larger unit first.
bool is_clock(const Candidate& candidate) {
  return std::all_of(candidate.names.begin(), candidate.names.end(), [&](const Parts& name) {
    return std::all_of(candidate.varying.begin(), candidate.varying.end(), [&](std::size_t column) {
      const std::string& text = name.numbers[column].text;
      return text.size() == 2 || (text.size() == 4 && column == candidate.varying.front());
    });
  });
}

/// Of several numbers that differ, the one that counts evenly; the first, where that one tells the files apart.
void choose_of_several(Candidate& candidate) {
  candidate.rank = 2;
  const bool clock = is_clock(candidate);
  for (const std::size_t column : candidate.varying) {
    if (!all_differ(candidate, column)) continue;
    const Raster raster = raster_of(numbers_in_order(candidate, column));
    const bool even = raster.stride > 0 && raster.missing == 0;
    if (!candidate.chosen || (even && !clock && candidate.raster.missing > 0)) {
      if (!candidate.chosen && column != candidate.varying.front() && (clock || !raster.is_regular)) continue;
      candidate.chosen = column;
      candidate.raster = raster;
    }
  }
}

Candidate read_all(const std::vector<std::string>& names, const Reading& reading) {
  Candidate candidate;
  for (const std::string& name : names) candidate.names.push_back(parts_of(name, reading));
  const Parts& first = candidate.names.front();
  for (const Parts& name : candidate.names) candidate.same_texts = candidate.same_texts && name.texts == first.texts;
  if (!candidate.same_texts) return candidate;
  for (std::size_t k = 0; k < first.numbers.size(); ++k)
    if (std::any_of(candidate.names.begin(), candidate.names.end(),
                    [&](const Parts& name) { return compare(name.numbers[k], first.numbers[k]) != 0; }))
      candidate.varying.push_back(k);
  if (candidate.varying.size() > 1) {
    choose_of_several(candidate);
  } else if (candidate.varying.size() == 1 && all_differ(candidate, candidate.varying.front()) &&
             (reading.decimals || can_be_counter(candidate, candidate.varying.front()))) {
    candidate.chosen = candidate.varying.front();
    candidate.raster = raster_of(numbers_in_order(candidate, *candidate.chosen));
    candidate.rank = candidate.raster.is_regular ? 0 : 1;
  }
  return candidate;
}

/// Names that leave no doubt need no words.
std::string note_on(const Candidate& candidate, const std::vector<std::string>& names, const NameOrder& result) {
  if (names.size() < 2) return "";
  const std::string &first = names[result.order.front()], &last = names[result.order.back()];
  if (!candidate.chosen)
    return fmt::format("the names differ in {}: the files are in natural order, from {} to {}",
                       candidate.same_texts ? "more than one number" : "letters", first, last);
  bool plain = candidate.varying.size() == 1;
  std::string before;
  for (const Parts& name : candidate.names) {
    before = name.texts[*candidate.chosen];
    const std::string& text = name.numbers[*candidate.chosen].text;
    plain = plain && !before.ends_with('-') && text.find_first_not_of("0123456789") == std::string::npos;
  }
  if (plain) return "";
  const auto number = [&](std::size_t i) { return candidate.names[i].numbers[*candidate.chosen].text; };
  return fmt::format("the files are in the order of the number after \"{}\" in their names: {}, {}{}", before,
                     number(result.order[0]), number(result.order[1]),
                     names.size() > 2 ? fmt::format(" ... {}", number(result.order.back())) : "");
}

using Twins = std::pair<std::size_t, std::size_t>;

/// Two names whose one number that differs is the same: 0.1 and 0.10.
std::optional<Twins> twins_of(const Candidate& candidate) {
  if (!candidate.same_texts || candidate.varying.size() != 1) return std::nullopt;
  const std::size_t column = candidate.varying.front();
  const std::vector<std::size_t> order = sorted_by(candidate, column);
  const auto same = std::adjacent_find(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return compare(candidate.names[a].numbers[column], candidate.names[b].numbers[column]) == 0;
  });
  return same == order.end() ? std::nullopt : std::optional<Twins>({same[0], same[1]});
}

/// 0.1, 0.2, 0.10 as 1, 2, 10: that must not be taken for granted, and times come only once.
void doubt_counters(const Candidate& candidate, const std::vector<std::string>& names, const Twins& same,
                    NameOrder& result) {
  const Parts& first = candidate.names.front();
  const std::size_t column = *candidate.chosen;
  const bool below_one = column > 0 && first.texts[column] == "." && first.numbers[column - 1].whole.empty();
  const bool like_time = below_one || first.texts.front().empty();
  const bool is_even = candidate.raster.is_regular && candidate.raster.missing == 0;
  if (like_time && !is_even) result.twins = same;
  result.note = fmt::format(
      "{} and {} would be the same number with decimals: the digits behind the point are counted as whole numbers",
      names[same.first], names[same.second]);
}

/// Whole numbers: the largest stride that fits them all.
double whole_stride(const std::vector<std::int64_t>& counts) {
  std::int64_t stride = 0;
  for (std::size_t i = 1; i < counts.size(); ++i) stride = std::gcd(stride, counts[i] - counts[i - 1]);
  return static_cast<double>(stride);
}

/// Others: the smallest difference, refined by the whole span, where all are multiples of it; else 0.
double decimal_stride(const std::vector<double>& numbers) {
  double least = HUGE_VAL;
  for (std::size_t i = 1; i < numbers.size(); ++i) least = std::min(least, numbers[i] - numbers[i - 1]);
  const double span = numbers.back() - numbers.front();
  for (int parts = 1; parts <= 4; ++parts) {
    double stride = least / parts;
    const double steps = std::round(span / stride);
    if (!(steps >= 1 && steps < 1e9)) return 0;
    stride = span / steps;
    const bool fits = std::all_of(numbers.begin(), numbers.end(), [&](double number) {
      const double step = (number - numbers.front()) / stride;
      return std::abs(step - std::round(step)) < raster_tolerance * std::max(1.0, step);
    });
    if (fits) return stride;
  }
  return 0;
}

}  // namespace

Raster raster_of(const NameOrder& names) {
  Raster raster;
  const std::vector<double>& numbers = names.numbers;
  if (numbers.size() < 2) return raster;
  const bool whole = !names.counts.empty();
  const double stride = whole ? whole_stride(names.counts) : decimal_stride(numbers);
  if (!(stride > 0) || !std::isfinite(stride)) return raster;
  std::size_t neighbors = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const double step =
        whole ? static_cast<double>(names.counts[i] - names.counts[0]) / stride : (numbers[i] - numbers[0]) / stride;
    raster.steps.push_back(static_cast<std::uint64_t>(std::llround(step)));
    if (i == 0) continue;
    const std::uint64_t gap = raster.steps[i] - raster.steps[i - 1];
    neighbors += gap == 1;
    if (gap > 1 && raster.missing == 0) raster.before_gap = i - 1;
    raster.missing += gap - 1;
  }
  raster.stride = stride;
  const bool most_are_neighbors = 2 * neighbors >= numbers.size() - 1;
  raster.is_regular =
      raster.steps.back() <= (most_are_neighbors ? most_steps_per_neighbor : most_steps_per_number) * numbers.size();
  return raster;
}

NameOrder order_of_names(const std::vector<std::string>& names) {
  NameOrder result;
  if (names.empty()) return result;
  std::optional<Candidate> best;
  std::optional<Twins> same_decimals;
  for (const Reading& reading : readings) {
    Candidate candidate = read_all(names, reading);
    if (!best) same_decimals = twins_of(candidate);
    if (!best || candidate.rank < best->rank) best = std::move(candidate);
  }
  if (best->chosen) {
    result = numbers_in_order(*best, *best->chosen);
  } else {
    result.order = sorted_by(*best, std::nullopt);
    result.is_clock = best->same_texts && best->varying.size() > 1 && is_clock(*best);
    for (std::size_t i = 0; i + 1 < result.order.size() && !result.twins; ++i)
      if (compare(best->names[result.order[i]], best->names[result.order[i + 1]]) == 0)
        result.twins = {result.order[i], result.order[i + 1]};
  }
  result.note = note_on(*best, names, result);
  if (same_decimals && best->chosen) doubt_counters(*best, names, *same_decimals, result);
  if (same_decimals && !best->chosen) result.twins = same_decimals;
  return result;
}

}  // namespace flowskin::scenes
