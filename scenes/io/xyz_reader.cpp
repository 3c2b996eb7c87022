#include "scenes/io/xyz_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

#include "common/number_text.h"
#include "scenes/io/number_words.h"
#include "scenes/io/particle_columns.h"
#include "scenes/io/text_columns.h"
#include "scenes/io/text_lines.h"

namespace flowskin::scenes {
namespace {

constexpr std::size_t most_xyz_columns = 4096;

using Words = std::vector<std::string>;

Words words_of(std::string_view line) {
  Words words;
  for (std::string_view word = take_word(line); !word.empty() && words.size() <= most_xyz_columns;
       word = take_word(line))
    words.emplace_back(word);
  return words;
}

bool is_blank_line(std::string_view line) { return line.find_first_not_of(" \t") == std::string_view::npos; }

/// A line with nothing but a whole number: how many particles follow.
std::optional<std::uint64_t> count_in(std::string_view line) {
  const std::string_view word = take_word(line);
  std::uint64_t count = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), count);
  if (error != std::errc() || end != word.data() + word.size() || !is_blank_line(line)) return std::nullopt;
  return count;
}

/// x y z, or a word and x y z.
bool is_row(const Words& words) {
  if (words.size() < 3) return false;
  const std::size_t first = words.size() == 3 ? 0 : 1;
  return std::all_of(words.begin() + static_cast<std::ptrdiff_t>(first),
                     words.begin() + static_cast<std::ptrdiff_t>(first) + 3,
                     [](const std::string& word) { return number_of_word(word).has_value(); });
}

bool is_headless_row(const Words& words) {
  return is_row(words) && (words.size() == 3 || (words.size() == 4 && !number_of_word(words[0])));
}

char small_letter(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// The text after `key` and = or :, where the key stands in the comment as a word of its own; in quotes it may hold
/// blanks.
std::optional<std::string_view> value_of(std::string_view comment, std::string_view key) {
  for (std::size_t at = 0; at + key.size() < comment.size(); ++at) {
    const auto same = [](char a, char b) { return small_letter(a) == b; };
    if (!std::equal(key.begin(), key.end(), comment.begin() + static_cast<std::ptrdiff_t>(at),
                    [&](char b, char a) { return same(a, b); }))
      continue;
    if (at > 0 && std::string_view(" \t,;\"'#").find(comment[at - 1]) == std::string_view::npos) continue;
    std::string_view rest = comment.substr(at + key.size());
    skip_space(rest, " \t");
    if (!rest.starts_with('=') && !rest.starts_with(':')) continue;
    rest.remove_prefix(1);
    skip_space(rest, " \t");
    if (rest.starts_with('"'))
      return rest.substr(1, rest.find('"', 1) == rest.npos ? rest.npos : rest.find('"', 1) - 1);
    return rest.substr(0, rest.find_first_of(" \t,;"));
  }
  return std::nullopt;
}

class XyzParser {
 public:
  XyzParser(std::string_view bytes, const std::string& name) : lines_(bytes, name) {}

  std::vector<ParticleTable> parse() {
    std::vector<ParticleTable> steps;
    std::string_view line;
    while (lines_.next(line)) {
      if (is_blank_line(line) || (steps.empty() && line.starts_with('#'))) continue;
      if (const auto count = count_in(line)) {
        steps.push_back(read_step(*count));
      } else if (steps.empty()) {
        return {read_headless(line)};
      } else {
        lines_.fail(fmt::format("expected the number of particles of the next step, found \"{}\"", line.substr(0, 40)));
      }
    }
    return steps;
  }

 private:
  ParticleTable read_step(std::uint64_t count) {
    const std::string_view comment = lines_.expect("a comment");
    ParticleTable table;
    if (const auto text = value_of(comment, "time")) table.time = number_of_word(*text);
    for (const char* key : {"timestep", "step", "frame"})
      if (const auto text = value_of(comment, key); text && !table.step) table.step = whole_number_of_word(*text);
    std::optional<TextColumns> columns;
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::string_view line = lines_.expect("a particle");
      if (!columns) columns.emplace(column_names(comment, words_of(line)));
      add_row(*columns, line);
    }
    if (!columns) columns.emplace(Words{"x", "y", "z"});
    columns->move_into(table);
    table.format = "XYZ";
    return table;
  }

  ParticleTable read_headless(std::string_view line) {
    TextColumns columns(column_names("", words_of(line)));
    do {
      if (!is_blank_line(line) && !line.starts_with('#')) add_row(columns, line);
    } while (lines_.next(line));
    ParticleTable table;
    columns.move_into(table);
    table.format = "XYZ without head";
    return table;
  }

  void add_row(TextColumns& columns, std::string_view line) const {
    if (const std::size_t found = columns.add_row(line, lines_.number()); found != columns.size())
      lines_.fail(fmt::format("{} values, {} were expected; the file may be truncated", found, columns.size()));
  }

  /// What the words of a line are.
  Words column_names(std::string_view comment, const Words& row) const {
    if (row.size() > most_xyz_columns) lines_.fail("more than 4096 values; this is no particle file");
    if (const auto properties = value_of(comment, "properties")) return names_of_properties(*properties);
    const Words words = words_of(comment);
    if (words.size() == row.size() && names_positions(words)) return words;
    if (!is_row(row)) lines_.fail("expected x y z, or an element and x y z");
    Words names = row.size() == 3 ? Words{"x", "y", "z"} : Words{"element", "x", "y", "z"};
    names.resize(row.size());
    return names;
  }

  /// species:S:1:pos:R:3: name, type (S: word, L: yes or no, R, I: numbers) and number of columns of each property.
  Words names_of_properties(std::string_view text) const {
    Words parts, names;
    for (;;) {
      const std::size_t end = text.find(':');
      parts.emplace_back(text.substr(0, end));
      if (end == std::string_view::npos) break;
      text.remove_prefix(end + 1);
    }
    for (std::size_t k = 0; k + 3 <= parts.size(); k += 3) {
      const auto size = count_in(parts[k + 2]);
      if (!size || *size == 0 || *size > most_xyz_columns || names.size() > most_xyz_columns)
        lines_.fail(fmt::format("Properties=...{}:{}:{}: expected a number of columns last", parts[k].substr(0, 40),
                                parts[k + 1].substr(0, 40), parts[k + 2].substr(0, 40)));
      const std::string base = parts[k] == "velo" ? "velocity" : parts[k];
      for (std::uint64_t i = 0; i < *size; ++i) names.push_back(*size == 1 ? base : base + "_" + std::to_string(i));
    }
    return names;
  }

  TextLines lines_;
};

}  // namespace

bool is_xyz(std::string_view bytes) {
  const std::string none;
  TextLines lines(bytes, none);
  std::string_view line;
  bool has_line = lines.next(line);
  for (; has_line && (is_blank_line(line) || line.starts_with('#')); has_line = lines.next(line)) {
    while (line.starts_with('#')) line.remove_prefix(1);
    if (names_positions(words_of(line))) return false;  // a table whose names stand behind a #
  }
  if (!has_line) return false;
  if (is_headless_row(words_of(line)) && line.find(',') == std::string_view::npos) return true;
  const auto count = count_in(line);
  if (!count || !lines.next(line)) return count.has_value();
  const bool tells_columns = value_of(line, "properties").has_value() || names_positions(words_of(line));
  if (!lines.next(line)) return *count == 0;
  return *count == 0 ? is_blank_line(line) || count_in(line) : tells_columns || is_row(words_of(line));
}

std::vector<ParticleTable> parse_xyz(std::string_view bytes, const std::string& name) {
  return XyzParser(bytes, name).parse();
}

}  // namespace flowskin::scenes
