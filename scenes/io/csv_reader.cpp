#include "scenes/io/csv_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "common/errors.h"
#include "common/number_text.h"
#include "scenes/io/particle_columns.h"

namespace flowskin::scenes {
namespace {

constexpr std::size_t most_columns = 4096;

/// The lines of a text, counted.
class Lines {
 public:
  explicit Lines(std::string_view text) : text_(text) {
    if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);  // the mark that Windows programs put first
  }
  bool next(std::string_view& line) {
    if (text_.empty()) return false;
    const std::size_t end = text_.find('\n');
    line = text_.substr(0, end);
    text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
    while (line.ends_with('\r') || line.ends_with(' ')) line.remove_suffix(1);
    skip_space(line, " ");
    ++number_;
    return true;
  }
  std::size_t number() const { return number_; }

 private:
  std::string_view text_;
  std::size_t number_ = 0;
};

char find_separator(std::string_view names) {
  bool quoted = false;
  for (const char wanted : {',', ';', '\t'}) {
    for (const char c : names) {
      if (c == '"') quoted = !quoted;
      if (c == wanted && !quoted) return wanted;
    }
  }
  return ' ';
}

/// Removes and returns the next cell; false at the end of the line. Spaces around it and quotes are taken off.
class Cells {
 public:
  Cells(std::string_view line, char separator) : rest_(line), separator_(separator) {}

  bool next(std::string_view& cell) {
    if (done_) return false;
    skip_space(rest_, separator_ == '\t' ? " " : " \t");
    if (rest_.starts_with('"')) {
      const std::size_t end = rest_.find('"', 1);
      cell = rest_.substr(1, end == std::string_view::npos ? end : end - 1);
      rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
      skip_space(rest_, separator_ == '\t' ? " " : " \t");
    } else {
      const std::size_t end = separator_ == ' ' ? rest_.find_first_of(" \t") : rest_.find(separator_);
      cell = rest_.substr(0, end);
      rest_.remove_prefix(cell.size());
      while (cell.ends_with(' ') || cell.ends_with('\t')) cell.remove_suffix(1);
    }
    if (separator_ == ' ') skip_space(rest_, " \t");
    if (rest_.empty()) {
      done_ = true;
    } else if (separator_ != ' ' && rest_.front() == separator_) {
      rest_.remove_prefix(1);
    }
    return true;
  }

 private:
  std::string_view rest_;
  char separator_;
  bool done_ = false;
};

bool is_number(std::string_view cell) {
  double value = 0;
  return take_number(cell, value) && cell.empty();
}

class CsvParser {
 public:
  CsvParser(std::string_view bytes, const std::string& name) : lines_(bytes), bytes_(bytes), name_(name) {}

  ParticleTable parse() {
    std::string_view line;
    read_names(line);
    while (lines_.next(line)) {
      if (!line.empty() && line.front() != '#') read_row(line);
    }
    ParticleTable table;
    table.format = "CSV";
    table.count = rows_;
    for (std::size_t k = 0; k < names_.size(); ++k) {
      if (!is_numeric_[k]) continue;
      if (rows_ > 0 && plain_column_name(names_[k]) == "time") table.time = columns_[k].front();
      if (!table.columns.emplace(names_[k], std::move(columns_[k])).second)
        fail(names_line_, fmt::format("the column \"{}\" is there twice", names_[k]));
    }
    return table;
  }

 private:
  [[noreturn]] void fail(std::size_t line, const std::string& message) const {
    throw InputError(fmt::format("{}, line {}: {}", name_, line, message));
  }

  /// The first line that is neither empty nor a remark; a remark that looks like names counts where no names follow.
  void read_names(std::string_view& line) {
    std::string remark;
    for (;;) {
      if (!lines_.next(line))
        throw InputError(name_ + ": there is no line of column names, such as x,y,z,vx,vy,vz,id; the file is empty");
      if (line.empty()) continue;
      if (line.front() != '#') break;
      remark = std::string(line.substr(1));
    }
    names_line_ = lines_.number();
    split_names(line);
    if (std::none_of(names_.begin(), names_.end(), [](const std::string& cell) { return is_number(cell); })) return;
    const std::string first_row(line);
    split_names(remark);
    if (remark.empty() || std::any_of(names_.begin(), names_.end(), [](const std::string& n) { return is_number(n); }))
      fail(names_line_, "expected column names, such as x,y,z,vx,vy,vz,id, but there are numbers");
    read_row(first_row);
  }

  void split_names(std::string_view line) {
    separator_ = find_separator(line);
    names_.clear();
    Cells cells(line, separator_);
    for (std::string_view cell; cells.next(cell);) names_.emplace_back(cell);
    while (!names_.empty() && names_.back().empty()) names_.pop_back();  // a separator at the end of the line
    if (names_.size() > most_columns) fail(names_line_, "there are more than 4096 columns; this is no particle table");
    columns_.assign(names_.size(), {});
    is_numeric_.assign(names_.size(), true);
  }

  void read_row(std::string_view line) {
    Cells cells(line, separator_);
    std::size_t k = 0;
    for (std::string_view cell; k < names_.size() && cells.next(cell); ++k) {
      if (!is_numeric_[k]) continue;
      double value = 0;
      std::string_view rest = cell;
      if (!take_number(rest, value) || !rest.empty()) {
        // Words in the first row: a column of names, which is nobody's business here.
        if (rows_ == 0 && !cell.empty() && columns_[k].empty() && !is_needed(names_[k])) {
          is_numeric_[k] = false;
          continue;
        }
        fail(lines_.number(), fmt::format("expected a number as \"{}\", found \"{}\"{}", names_[k], cell.substr(0, 40),
                                          comma_hint(cell)));
      }
      columns_[k].push_back(value);
    }
    std::string_view surplus;
    const bool too_long = cells.next(surplus) && (!surplus.empty() || cells.next(surplus));
    if (k < names_.size() || too_long)
      fail(lines_.number(), fmt::format("{} values where line {} has {} column names",
                                        too_long ? "more" : std::to_string(k), names_line_, names_.size()) +
                                (k < names_.size() ? "; the file may be truncated" : ""));
    ++rows_;
  }

  static bool is_needed(const std::string& name) {
    const std::string plain = plain_column_name(name);
    return plain == "x" || plain == "y" || plain == "z" || plain == "id";
  }

  static std::string comma_hint(std::string_view cell) {
    const bool comma = cell.find(',') != std::string_view::npos;
    return comma ? "; numbers are written with a point, not a comma" : "";
  }

  Lines lines_;
  std::string_view bytes_;
  const std::string& name_;
  std::size_t names_line_ = 0, rows_ = 0;
  char separator_ = ',';
  std::vector<std::string> names_;
  std::vector<std::vector<double>> columns_;
  std::vector<bool> is_numeric_;
};

}  // namespace

ParticleTable parse_csv(std::string_view bytes, const std::string& name) { return CsvParser(bytes, name).parse(); }

}  // namespace flowskin::scenes
