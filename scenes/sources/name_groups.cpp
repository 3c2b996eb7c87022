#include "scenes/sources/name_groups.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace flowskin::scenes {
namespace {

bool is_digit_of_name(char c) { return c >= '0' && c <= '9'; }

/// Letters before, between and behind the numbers, and the numbers as they are written; decimals and exponents of
/// signed ones belong to them.
struct NameParts {
  std::vector<std::string> letters{""}, numbers;
};

std::size_t end_of_number(const std::string& name, std::size_t at) {
  const auto digits = [&](std::size_t from) {
    while (from < name.size() && is_digit_of_name(name[from])) ++from;
    return from;
  };
  std::size_t end = digits(at);
  if (end + 1 < name.size() && name[end] == '.' && is_digit_of_name(name[end + 1])) end = digits(end + 1);
  if (end + 2 < name.size() && (name[end] == 'e' || name[end] == 'E') &&
      (name[end + 1] == '-' || name[end + 1] == '+') && is_digit_of_name(name[end + 2]))
    end = digits(end + 2);
  return end;
}

NameParts parts_of_name(const std::string& name) {
  NameParts parts;
  for (std::size_t i = 0; i < name.size();) {
    if (!is_digit_of_name(name[i])) {
      parts.letters.back() += name[i++];
      continue;
    }
    const std::size_t end = end_of_number(name, i);
    parts.numbers.push_back(name.substr(i, end - i));
    parts.letters.emplace_back();
    i = end;
  }
  return parts;
}

/// Small letters, without signs in front of numbers.
std::vector<std::string> plain_letters(const NameParts& parts) {
  std::vector<std::string> plain = parts.letters;
  for (std::size_t k = 0; k < plain.size(); ++k) {
    for (char& c : plain[k]) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    if (k + 1 < plain.size() && (plain[k].ends_with('-') || plain[k].ends_with('+'))) plain[k].pop_back();
  }
  return plain;
}

/// @param kept a number that is written as it is, the others are `wild`
std::string pattern_of(const NameParts& parts, const std::string& wild, std::optional<std::size_t> kept) {
  std::string pattern = parts.letters.front();
  for (std::size_t k = 0; k < parts.numbers.size(); ++k)
    pattern += (kept == k ? parts.numbers[k] : wild) + parts.letters[k + 1];
  return pattern;
}

/// How often the other numbers of one value of number `column` come again with another value of it: all of them at 1.
double overlap(const std::vector<NameParts>& names, std::size_t column) {
  std::map<std::vector<std::string>, std::size_t> others;
  for (const NameParts& name : names) {
    std::vector<std::string> rest = name.numbers;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(column));
    ++others[rest];
  }
  const auto again = std::count_if(others.begin(), others.end(), [](const auto& entry) { return entry.second > 1; });
  return static_cast<double>(again) / static_cast<double>(others.size());
}

/// The number that tells bodies apart: of few values, most of whose other numbers come again.
std::optional<std::size_t> number_of_bodies(const std::vector<NameParts>& names) {
  constexpr double most = 0.5;
  std::optional<std::size_t> best;
  std::size_t fewest = 0, varying = 0;
  for (std::size_t k = 0; k < names.front().numbers.size(); ++k) {
    std::set<std::string> values;
    for (const NameParts& name : names) values.insert(name.numbers[k]);
    varying += values.size() > 1;
    if (values.size() < 2 || 2 * values.size() > names.size() || overlap(names, k) <= most) continue;
    if (!best || values.size() < fewest) {
      best = k;
      fewest = values.size();
    }
  }
  return varying > 1 ? best : std::nullopt;
}

/// Whether * would take in letters that part another group from this one.
bool star_would_take(const NameParts& group, const NameParts& other) {
  const std::string &start = group.letters.front(), &end = group.letters.back();
  const std::string name = pattern_of(other, "0", std::nullopt);
  return name.size() >= start.size() + end.size() && name.starts_with(start) && name.ends_with(end);
}

}  // namespace

std::vector<NameGroup> groups_of_names(const std::vector<std::string>& names) {
  std::vector<NameParts> parts;
  std::map<std::vector<std::string>, std::vector<std::size_t>> by_letters;
  for (const std::string& name : names) {
    parts.push_back(parts_of_name(name));
    by_letters[plain_letters(parts.back())].push_back(parts.size() - 1);
  }
  std::vector<NameGroup> groups;
  if (by_letters.size() == 1) {
    const auto column = number_of_bodies(parts);
    std::map<std::string, std::vector<std::size_t>> by_number;
    for (std::size_t i = 0; i < names.size(); ++i) by_number[column ? parts[i].numbers[*column] : ""].push_back(i);
    for (auto& [number, members] : by_number)
      groups.push_back({pattern_of(parts[members.front()], "*", column), std::move(members)});
    return groups;
  }
  for (const auto& group : by_letters) {
    const NameParts& first = parts[group.second.front()];
    const bool ambiguous = std::any_of(by_letters.begin(), by_letters.end(), [&](const auto& other) {
      return &other != &group && star_would_take(first, parts[other.second.front()]);
    });
    groups.push_back({pattern_of(first, ambiguous ? "%d" : "*", std::nullopt), group.second});
  }
  return groups;
}

bool are_several_bodies(const std::vector<NameGroup>& groups, const std::vector<std::string>& names) {
  if (groups.size() < 2) return false;
  constexpr std::size_t series = 3;
  const auto at_least = [&](std::size_t count) {
    return std::count_if(groups.begin(), groups.end(), [&](const NameGroup& g) { return g.names.size() >= count; });
  };
  const bool any_number = std::any_of(names.begin(), names.end(), [](const std::string& name) {
    return std::any_of(name.begin(), name.end(), is_digit_of_name);
  });
  return at_least(2) >= 2 || at_least(series) >= 1 || !any_number;
}

}  // namespace flowskin::scenes
