#include "scenes/sources/file_pattern.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <regex>

#include "scenes/nearest_name.h"
#include "scenes/scene_file.h"

namespace flowskin::scenes {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// The pattern as a regular expression with one group a wildcard.
std::regex pattern_expression(const std::string& pattern) {
  static const std::regex printf_number("%[0-9]*d");
  std::string expression;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    const char c = pattern[i];
    std::smatch match;
    const std::string rest = pattern.substr(i);
    if (c == '*') {
      expression += "(.*)";
    } else if (c == '?') {
      expression += "(.)";
    } else if (std::regex_search(rest, match, printf_number, std::regex_constants::match_continuous)) {
      expression += "([0-9]+)";
      i += static_cast<std::size_t>(match.length()) - 1;
    } else {
      if (std::string("^$\\.+()[]{}|").find(c) != std::string::npos) expression += '\\';
      expression += c;
    }
  }
  return std::regex(expression);
}

struct NumberedFile {
  std::filesystem::path path;
  std::string name;
  std::string digits;  ///< What the wildcards stand for, without leading zeros, where that is a number; else "".
};

std::string number_of(const std::smatch& match) {
  std::string captured;
  for (std::size_t i = 1; i < match.size(); ++i) captured += match.str(i);
  if (captured.empty() || !std::all_of(captured.begin(), captured.end(), is_digit)) return "";
  const std::size_t first = captured.find_first_not_of('0');
  return first == std::string::npos ? "0" : captured.substr(first);
}

bool number_less(const std::string& a, const std::string& b) {
  return a.size() != b.size() ? a.size() < b.size() : a < b;
}

/// Runs of digits are compared as numbers, the rest letter by letter.
bool natural_less(const std::string& a, const std::string& b) {
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const auto run = [](const std::string& s, std::size_t& k) {
        while (k + 1 < s.size() && s[k] == '0' && is_digit(s[k + 1])) ++k;
        const std::size_t start = k;
        while (k < s.size() && is_digit(s[k])) ++k;
        return s.substr(start, k - start);
      };
      const std::string x = run(a, i), y = run(b, j);
      if (x != y) return number_less(x, y);
    } else {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i;
      ++j;
    }
  }
  return a.size() - i != b.size() - j ? a.size() - i < b.size() - j : a < b;
}

void check_numbering(const std::vector<NumberedFile>& files) {
  for (std::size_t i = 1; i < files.size(); ++i) {
    const std::string &last = files[i - 1].digits, &next = files[i].digits;
    if (last == next) {
      throw SceneError(fmt::format("{}: has the same number as {}; a sequence has one file a number",
                                   files[i].path.string(), files[i - 1].name));
    }
    // Numbers of more than 18 digits are time stamps, not counters.
    if (next.size() <= 18 && std::stoull(next) != std::stoull(last) + 1) {
      throw SceneError(
          fmt::format("{}: follows {} but {} files in between are missing; a sequence has no gaps in its numbers",
                      files[i].path.string(), files[i - 1].name, std::stoull(next) - std::stoull(last) - 1));
    }
  }
}

std::vector<NumberedFile> matching_files(const std::filesystem::path& pattern) {
  const std::filesystem::path folder = pattern.has_parent_path() ? pattern.parent_path() : ".";
  const std::regex expression = pattern_expression(pattern.filename().string());
  std::vector<NumberedFile> files;
  std::vector<std::string> names;
  std::error_code error;
  std::filesystem::directory_iterator entry(folder, error);
  if (error) throw SceneError(fmt::format("{}: cannot look into the folder {}", pattern.string(), folder.string()));
  for (const std::filesystem::directory_iterator end; entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    std::smatch match;
    if (entry->is_regular_file(error)) names.push_back(name);
    if (!entry->is_directory(error) && std::regex_match(name, match, expression)) {
      files.push_back({entry->path(), name, number_of(match)});
    }
  }
  if (files.empty()) {
    std::sort(names.begin(), names.end());
    throw SceneError(
        fmt::format("{}: no file matches{}", pattern.string(), did_you_mean(pattern.filename().string(), names)));
  }
  return files;
}

}  // namespace

std::vector<std::filesystem::path> files_of_pattern(const std::string& pattern) {
  std::error_code error;
  if (std::filesystem::is_directory(pattern, error)) {
    throw SceneError(fmt::format("{}: this is a folder; name its files, for example {}/*.ply", pattern, pattern));
  }
  std::vector<NumberedFile> files = matching_files(pattern);
  const bool numbered =
      std::all_of(files.begin(), files.end(), [](const NumberedFile& file) { return !file.digits.empty(); });
  std::sort(files.begin(), files.end(), [numbered](const NumberedFile& a, const NumberedFile& b) {
    return numbered && a.digits != b.digits ? number_less(a.digits, b.digits) : natural_less(a.name, b.name);
  });
  if (numbered) check_numbering(files);
  std::vector<std::filesystem::path> paths;
  for (const NumberedFile& file : files) paths.push_back(file.path);
  return paths;
}

}  // namespace flowskin::scenes
