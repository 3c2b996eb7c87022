#include "scenes/sources/file_pattern.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <string_view>

#include "common/errors.h"
#include "common/number_text.h"
#include "scenes/io/particle_file.h"
#include "scenes/nearest_name.h"
#include "scenes/sources/name_groups.h"
#include "scenes/sources/name_order.h"

namespace flowskin::scenes {
namespace {

using Paths = std::vector<std::filesystem::path>;

/// In names of groups of files.
constexpr const char* fluid_words[] = {"fluid", "liquid", "water", "particle"};

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

enum class Entry { files, folders };

/// Names of files or folders in a folder; empty where it cannot be looked into.
std::optional<std::vector<std::string>> names_in(const std::filesystem::path& folder, Entry kind = Entry::files) {
  std::error_code error;
  std::filesystem::directory_iterator entry(folder, error);
  if (error) return std::nullopt;
  std::vector<std::string> names;
  for (const std::filesystem::directory_iterator end; entry != end; entry.increment(error)) {
    std::error_code ignored;
    if (entry->is_directory(ignored) == (kind == Entry::folders)) names.push_back(entry->path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> names_matching(const std::vector<std::string>& names, const std::string& pattern) {
  const std::vector<PatternPart> parts = parts_of(pattern);
  std::vector<std::string> matching;
  for (const std::string& name : names)
    if (fits(name, parts)) matching.push_back(name);
  return matching;
}

bool has_wildcards(const std::string& name) { return name.find_first_of("*?%") != std::string::npos; }

/// What tells the kind of a file: ".csv", ".csv.gz"; empty where the name ends in a number, as dump.100 does.
std::string kind_of(const std::filesystem::path& path) {
  std::string end = path.extension().string();
  std::transform(end.begin(), end.end(), end.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  if (end.size() > 1 && end.find_first_not_of("0123456789eE+-", 1) == std::string::npos && end[1] >= '0' &&
      end[1] <= '9')
    return "";
  return end == ".gz" ? kind_of(path.stem()) + end : end;
}

bool is_particle_file(const std::string& name) { return is_particle_extension(kind_of(name)); }

/// Files of a folder without known ends, where they differ in their number only: part.0000, part.0001.
std::vector<std::string> numbered_without_end(const std::vector<std::string>& names) {
  std::vector<std::string> plain;
  for (const std::string& name : names)
    if (kind_of(name).empty() && !name.starts_with('.')) plain.push_back(name);
  if (order_of_names(plain).numbers.empty()) plain.clear();
  return plain;
}

/// One folder a time, as OpenFOAM has them: the file that each holds.
Paths files_in_numbered_folders(const std::filesystem::path& folder) {
  const std::vector<std::string> folders = names_in(folder, Entry::folders).value_or(std::vector<std::string>{});
  const NameOrder order = order_of_names(folders);
  if (order.twins)
    throw InputError(
        fmt::format("{}: has the same number as {}; a sequence has one file per number: list the files that "
                    "count",
                    (folder / folders[order.twins->second]).string(), folders[order.twins->first]));
  if (order.numbers.empty()) return {};
  Paths paths;
  for (const std::string& name : folders) {
    std::vector<std::string> inside = names_in(folder / name).value_or(std::vector<std::string>{});
    std::erase_if(inside, [](const std::string& file) { return !is_particle_file(file); });
    if (inside.empty()) continue;
    if (inside.size() > 1)
      throw InputError(
          fmt::format("{}: this folder holds {} particle files; name the one that counts, for example "
                      "'{}/*/{}'",
                      (folder / name).string(), inside.size(), folder.string(), inside.front()));
    paths.push_back(folder / name / inside.front());
  }
  return paths;
}

Paths files_in_folder(const std::filesystem::path& folder) {
  const std::vector<std::string> all = names_in(folder).value_or(std::vector<std::string>{});
  std::vector<std::string> names, kinds;
  for (const std::string& name : all)
    if (is_particle_file(name)) names.push_back(name);
  if (names.empty()) names = numbered_without_end(all);
  Paths paths;
  for (const std::string& name : names) {
    paths.push_back(folder / name);
    kinds.push_back(kind_of(name));
  }
  if (paths.empty()) paths = files_in_numbered_folders(folder);
  if (paths.empty())
    throw InputError(
        fmt::format("{}: this folder holds no particle files ({})", folder.string(), particle_extensions()));
  std::sort(kinds.begin(), kinds.end());
  if (!kinds.empty() && kinds.front() != kinds.back())
    throw InputError(fmt::format("{}: this folder holds {} and {} files; name one kind, for example '{}/*{}'",
                                 folder.string(), kinds.front(), kinds.back(), folder.string(), kinds.front()));
  return paths;
}

/// The folders that a pattern means, such as run/*/.
Paths matching_folders(const std::filesystem::path& pattern) {
  std::error_code error;
  if (pattern.empty() || !has_wildcards(pattern.string()) || std::filesystem::is_directory(pattern, error))
    return {pattern.empty() ? "." : pattern};
  Paths found;
  for (const std::filesystem::path& folder : matching_folders(pattern.parent_path()))
    for (const std::string& name : names_matching(names_in(folder, Entry::folders).value_or(std::vector<std::string>{}),
                                                  pattern.filename().string()))
      found.push_back(folder / name);
  return found;
}

Paths matching_files(const std::filesystem::path& pattern) {
  std::error_code error;
  if (std::filesystem::is_directory(pattern, error)) return files_in_folder(pattern);
  if (std::filesystem::exists(pattern, error)) return {pattern};
  if (pattern.filename().string().size() > longest_name)
    throw InputError(fmt::format("{}...: no file has so long a name", pattern.string().substr(0, longest_name)));
  Paths paths;
  std::vector<std::string> others;
  for (const std::filesystem::path& folder : matching_folders(pattern.parent_path())) {
    const auto names = names_in(folder);
    if (!names) throw InputError(fmt::format("{}: cannot look into the folder {}", pattern.string(), folder.string()));
    for (const std::string& name : names_matching(*names, pattern.filename().string())) paths.push_back(folder / name);
    others.insert(others.end(), names->begin(), names->end());
  }
  if (paths.empty()) {
    throw InputError(
        fmt::format("{}: no file matches{}", pattern.string(), did_you_mean(pattern.filename().string(), others)));
  }
  return paths;
}

void check_formats(const Paths& paths) {
  for (const auto& path : paths) {
    if (kind_of(path) != kind_of(paths.front()))
      throw InputError(fmt::format("{}: follows {}; the files of a sequence have one format, name those of one kind",
                                   path.string(), paths.front().filename().string()));
  }
}

/// What tells the files apart: their own names or, where those are the same, the names of their folders, too.
std::vector<std::string> telling_names(const Paths& paths) {
  std::vector<std::string> names;
  for (const auto& path : paths) names.push_back(path.filename().string());
  std::vector<std::string> sorted = names;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end()) return names;
  const auto parts = [](const std::filesystem::path& path) {
    return std::vector<std::filesystem::path>(path.begin(), path.end());
  };
  const auto first = parts(paths.front());
  std::size_t common = first.size();
  for (const auto& path : paths) {
    const auto other = parts(path);
    common = std::min(
        common, static_cast<std::size_t>(std::mismatch(first.begin(), first.end(), other.begin(), other.end()).first -
                                         first.begin()));
  }
  for (std::size_t k = 0; k < paths.size(); ++k) {
    std::filesystem::path rest;
    const auto all = parts(paths[k]);
    for (std::size_t i = common; i < all.size(); ++i) rest /= all[i];
    names[k] = rest.string();
  }
  return names;
}

/// What a group is called by, first in the order: what most programs call the fluid.
bool is_called_fluid(const std::string& pattern) {
  std::string small = pattern;
  for (char& c : small) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return std::any_of(std::begin(fluid_words), std::end(fluid_words),
                     [&](const char* word) { return small.find(word) != std::string::npos; });
}

/// @throws InputError where the names are those of several bodies, which have no order together
/// @param listed the user named every file
void refuse_several_bodies(const Paths& paths, const std::vector<std::string>& names, bool listed) {
  constexpr std::size_t most_named = 6;
  std::vector<NameGroup> groups = groups_of_names(names);
  const bool any_series = std::any_of(groups.begin(), groups.end(), [](const auto& g) { return g.names.size() > 1; });
  if (!are_several_bodies(groups, names) || (listed && !any_series)) return;
  std::stable_sort(groups.begin(), groups.end(), [](const NameGroup& a, const NameGroup& b) {
    return std::pair(is_called_fluid(a.pattern), a.names.size()) >
           std::pair(is_called_fluid(b.pattern), b.names.size());
  });
  std::vector<std::string> told;
  for (const NameGroup& group : groups)
    told.push_back(group.names.size() == 1 ? names[group.names.front()]
                                           : fmt::format("{} ({} files)", group.pattern, group.names.size()));
  if (told.size() > most_named) told[most_named - 1] = fmt::format("{} more", told.size() - most_named + 1);
  told.resize(std::min(told.size(), most_named));
  const NameGroup& one = groups.front();
  std::filesystem::path place = paths[one.names.front()];  // without what `names` tells
  const std::filesystem::path told_parts = names[one.names.front()];
  for (auto part = told_parts.begin(); part != told_parts.end(); ++part) place = place.parent_path();
  const std::string example = one.names.size() == 1 ? names[one.names.front()] : one.pattern;
  throw InputError(
      fmt::format("{}: these are {} groups of files, not one sequence: {}. Give those of one body, for example '{}'{}",
                  place.string(), groups.size(), fmt::join(told, ", "), (place / example).string(),
                  any_series ? "" : "; the order of files is told by numbers in their names"));
}

std::string listed(const std::vector<double>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(numbers.size(), 3); ++i)
    text += (i ? ", " : "") + number_text(numbers[i]);
  return text + (numbers.size() > 3 ? ", ..." : "");
}

/// Steps from the numbers, which ascend; without gaps where the numbers are no frame numbers.
void count_steps(const NameOrder& names, NumberedFiles& files) {
  const Raster raster = raster_of(names);
  if (!raster.is_regular || raster.stride == 0) {
    if (files.paths.size() > 1)
      files.uneven = fmt::format(
          "the numbers in the names ({}) have no even steps: they only give the order, no file counts as missing, and "
          "all are the same time apart; --times-in-names would take the numbers for times",
          listed(names.numbers));
    return;
  }
  files.steps = raster.steps;
  if (raster.missing > 0)
    files.missing = fmt::format("{} of {} files are missing by their numbers (the first after {})", raster.missing,
                                raster.steps.back() + 1, files.paths[raster.before_gap].filename().string());
}

}  // namespace

NumberedFiles files_of_patterns(const std::vector<std::string>& names) {
  NumberedFiles files;
  for (const std::string& name : names) {
    const Paths found = matching_files(name);
    files.paths.insert(files.paths.end(), found.begin(), found.end());
  }
  if (files.paths.empty()) throw InputError("no particle files are given");
  std::sort(files.paths.begin(), files.paths.end());
  const auto twice = std::adjacent_find(files.paths.begin(), files.paths.end());
  if (twice != files.paths.end()) throw InputError(twice->string() + ": is given twice");
  check_formats(files.paths);
  const std::vector<std::string> telling = telling_names(files.paths);
  const NameOrder names_in_order = order_of_names(telling);
  if (names_in_order.numbers.empty() && !names_in_order.is_clock)
    refuse_several_bodies(files.paths, telling, names.size() == files.paths.size());
  if (names_in_order.twins)
    throw InputError(fmt::format(
        "{}: has the same number as {}; a sequence has one file per number: list the "
        "files that count",
        files.paths[names_in_order.twins->second].string(), files.paths[names_in_order.twins->first].string()));
  const Paths paths = std::move(files.paths);
  files.paths.clear();
  for (const std::size_t k : names_in_order.order) files.paths.push_back(paths[k]);
  files.steps.resize(paths.size());
  std::iota(files.steps.begin(), files.steps.end(), std::uint64_t{0});
  if (!names_in_order.note.empty()) files.notes.push_back(names_in_order.note);
  if (names_in_order.numbers.empty()) return files;
  files.numbers = names_in_order.numbers;
  files.look_like_times = names_in_order.looks_like_times;
  count_steps(names_in_order, files);
  return files;
}

}  // namespace flowskin::scenes
