#include "scenes/sources/file_pattern.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <string_view>

#include "common/errors.h"
#include "scenes/io/particle_file.h"
#include "scenes/nearest_name.h"

namespace flowskin::scenes {
namespace {

using Paths = std::vector<std::filesystem::path>;

/// Numbers with more gaps than this are no frame numbers: then files follow each other at once.
constexpr std::uint64_t most_steps_per_file = 4;

/// Of a file, in bytes.
constexpr std::size_t longest_name = 255;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// One step of a pattern: what one letter, or a run of them, must be.
struct PatternPart {
  enum class Kind { letter, any_letter, any_letters, digits };
  Kind kind;
  char letter = 0;
};

/// How many letters %d, %4d or %04d takes at this place of a pattern; 0: it is something else.
std::size_t length_of_number(std::string_view pattern) {
  if (!pattern.starts_with('%')) return 0;
  const std::size_t end = std::min(pattern.find_first_not_of("0123456789", 1), pattern.size());
  return end < pattern.size() && pattern[end] == 'd' ? end + 1 : 0;
}

std::vector<PatternPart> parts_of(std::string_view pattern) {
  using Kind = PatternPart::Kind;
  std::vector<PatternPart> parts;
  while (!pattern.empty()) {
    const std::size_t number = length_of_number(pattern);
    const char c = pattern.front();
    if (number > 0) {
      parts.push_back({Kind::digits});
    } else {
      parts.push_back({c == '*' ? Kind::any_letters : c == '?' ? Kind::any_letter : Kind::letter, c});
    }
    pattern.remove_prefix(std::max<std::size_t>(number, 1));
  }
  return parts;
}

/// Whether the whole name fits. At each letter it is known which parts may come next, so the time is never more than
/// that of the letters times the parts.
bool fits(std::string_view name, const std::vector<PatternPart>& parts) {
  using Kind = PatternPart::Kind;
  // next[k]: the letters so far may end before part k.
  std::vector<char> next(parts.size() + 1, 0), now(next);
  const auto skip_empty = [&](std::vector<char>& places) {
    for (std::size_t k = 0; k < parts.size(); ++k)
      if (places[k] && parts[k].kind == Kind::any_letters) places[k + 1] = 1;
  };
  next[0] = 1;
  skip_empty(next);
  for (const char c : name) {
    now.swap(next);
    std::fill(next.begin(), next.end(), char{0});
    for (std::size_t k = 0; k < parts.size(); ++k) {
      if (!now[k]) continue;
      const Kind kind = parts[k].kind;
      if (kind == Kind::any_letters) next[k] = 1;
      if (kind == Kind::any_letter || (kind == Kind::letter && parts[k].letter == c)) next[k + 1] = 1;
      // A run of digits may end here or go on.
      if (kind == Kind::digits && is_digit(c)) next[k] = next[k + 1] = 1;
    }
    skip_empty(next);
  }
  return next.back() != 0;
}

/// A name as text and runs of digits in turn, text first; runs without leading zeros.
std::vector<std::string> split_at_digits(const std::string& name) {
  std::vector<std::string> parts(1);
  for (std::size_t i = 0; i < name.size();) {
    if (!is_digit(name[i])) {
      parts.back() += name[i++];
      continue;
    }
    std::size_t end = i;
    while (end < name.size() && is_digit(name[end])) ++end;
    while (i + 1 < end && name[i] == '0') ++i;
    parts.push_back(name.substr(i, end - i));
    parts.emplace_back();
    i = end;
  }
  return parts;
}

bool number_less(const std::string& a, const std::string& b) {
  return a.size() != b.size() ? a.size() < b.size() : a < b;
}

/// Runs of digits are compared as numbers, the rest letter by letter.
bool natural_less(const std::filesystem::path& a, const std::filesystem::path& b) {
  const auto x = split_at_digits(a.filename().string()), y = split_at_digits(b.filename().string());
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    if (x[i] != y[i]) return i % 2 == 1 ? number_less(x[i], y[i]) : x[i] < y[i];
  }
  return x.size() != y.size() ? x.size() < y.size() : a < b;
}

/// The one run of digits in which the names differ, of each name; empty where there is no such run.
std::vector<std::string> numbers_of(const Paths& paths) {
  std::vector<std::vector<std::string>> names;
  for (const auto& path : paths) names.push_back(split_at_digits(path.filename().string()));
  std::optional<std::size_t> varying;
  for (const auto& name : names) {
    if (name.size() != names.front().size()) return {};
    for (std::size_t i = 0; i < name.size(); ++i) {
      if (name[i] == names.front()[i]) continue;
      if (i % 2 == 0 || (varying && *varying != i)) return {};
      varying = i;
    }
  }
  std::vector<std::string> numbers;
  for (const auto& name : names)
    if (varying) numbers.push_back(name[*varying]);
  return numbers;
}

/// Names of files in a folder; empty where it cannot be looked into.
std::optional<std::vector<std::string>> names_in(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::directory_iterator entry(folder, error);
  if (error) return std::nullopt;
  std::vector<std::string> names;
  for (const std::filesystem::directory_iterator end; entry != end; entry.increment(error)) {
    std::error_code ignored;
    if (!entry->is_directory(ignored)) names.push_back(entry->path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

Paths files_in_folder(const std::filesystem::path& folder) {
  Paths paths;
  std::vector<std::string> extensions;
  for (const std::string& name : names_in(folder).value_or(std::vector<std::string>{})) {
    const std::filesystem::path path = folder / name;
    if (!is_particle_extension(path.extension().string())) continue;
    paths.push_back(path);
    extensions.push_back(path.extension().string());
  }
  if (paths.empty())
    throw InputError(
        fmt::format("{}: this folder holds no particle files ({})", folder.string(), particle_extensions()));
  std::sort(extensions.begin(), extensions.end());
  if (extensions.front() != extensions.back())
    throw InputError(fmt::format("{}: this folder holds {} and {} files; name one kind, for example '{}/*{}'",
                                 folder.string(), extensions.front(), extensions.back(), folder.string(),
                                 extensions.front()));
  return paths;
}

Paths matching_files(const std::filesystem::path& pattern) {
  std::error_code error;
  if (std::filesystem::is_directory(pattern, error)) return files_in_folder(pattern);
  if (std::filesystem::exists(pattern, error)) return {pattern};
  const std::filesystem::path folder = pattern.has_parent_path() ? pattern.parent_path() : ".";
  const auto names = names_in(folder);
  if (!names) throw InputError(fmt::format("{}: cannot look into the folder {}", pattern.string(), folder.string()));
  if (pattern.filename().string().size() > longest_name)
    throw InputError(fmt::format("{}...: no file has so long a name", pattern.string().substr(0, longest_name)));
  const std::vector<PatternPart> parts = parts_of(pattern.filename().string());
  Paths paths;
  for (const std::string& name : *names)
    if (fits(name, parts)) paths.push_back(folder / name);
  if (paths.empty()) {
    throw InputError(
        fmt::format("{}: no file matches{}", pattern.string(), did_you_mean(pattern.filename().string(), *names)));
  }
  return paths;
}

void check_formats(const Paths& paths) {
  for (const auto& path : paths) {
    if (path.extension() != paths.front().extension())
      throw InputError(fmt::format("{}: follows {}; the files of a sequence have one format, name those of one kind",
                                   path.string(), paths.front().filename().string()));
  }
}

/// Steps from the numbers, which ascend; without gaps where the numbers are no frame numbers.
void count_steps(const std::vector<std::uint64_t>& numbers, NumberedFiles& files) {
  std::uint64_t stride = 0;
  for (std::size_t i = 1; i < numbers.size(); ++i) stride = std::gcd(stride, numbers[i] - numbers[i - 1]);
  const std::uint64_t steps = stride > 0 ? (numbers.back() - numbers.front()) / stride : 0;
  if (steps > most_steps_per_file * numbers.size()) {
    files.missing = "";
    return;
  }
  std::string first_gap;
  for (std::size_t i = 1; i < numbers.size(); ++i) {
    files.steps[i] = (numbers[i] - numbers.front()) / stride;
    if (first_gap.empty() && files.steps[i] > files.steps[i - 1] + 1)
      first_gap = files.paths[i - 1].filename().string();
  }
  const std::uint64_t missing = steps + 1 - numbers.size();
  if (missing > 0)
    files.missing =
        fmt::format("{} of {} files are missing by their numbers (the first after {})", missing, steps + 1, first_gap);
}

}  // namespace

NumberedFiles files_of_patterns(const std::vector<std::string>& names) {
  NumberedFiles files;
  for (const std::string& name : names) {
    const Paths found = matching_files(name);
    files.paths.insert(files.paths.end(), found.begin(), found.end());
  }
  if (files.paths.empty()) throw InputError("no particle files are given");
  std::sort(files.paths.begin(), files.paths.end(), natural_less);
  const auto twice = std::adjacent_find(files.paths.begin(), files.paths.end());
  if (twice != files.paths.end()) throw InputError(twice->string() + ": is given twice");
  check_formats(files.paths);
  files.steps.resize(files.paths.size());
  std::iota(files.steps.begin(), files.steps.end(), std::uint64_t{0});

  std::vector<std::uint64_t> numbers;
  const std::vector<std::string> digits = numbers_of(files.paths);
  for (std::size_t i = 0; i + 1 < files.paths.size(); ++i) {
    const auto a = split_at_digits(files.paths[i].filename().string());
    if (a == split_at_digits(files.paths[i + 1].filename().string()))
      throw InputError(fmt::format("{}: has the same number as {}; a sequence has one file per number",
                                   files.paths[i + 1].string(), files.paths[i].string()));
  }
  for (const std::string& number : digits) {
    if (number.size() > 18) return files;  // a time stamp, not a counter
    numbers.push_back(std::stoull(number));
  }
  if (!numbers.empty()) count_steps(numbers, files);
  return files;
}

}  // namespace flowskin::scenes
