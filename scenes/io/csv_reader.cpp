#include "scenes/io/csv_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "common/errors.h"
#include "common/number_text.h"
#include "scenes/io/number_words.h"
#include "scenes/io/particle_columns.h"
#include "scenes/io/time_columns.h"

namespace flowskin::scenes {
namespace {

constexpr std::size_t most_columns = 4096;

/// So many lines may stand before the column names.
constexpr std::size_t longest_preface = 100;

/// The lines of a text, counted.
class Lines {
 public:
  explicit Lines(std::string_view text) : text_(text), line_end_(text.find('\n') != text.npos ? '\n' : '\r') {
    if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);  // the mark that Windows programs put first
  }
  bool next(std::string_view& line) {
    if (text_.empty()) return false;
    const std::size_t end = text_.find(line_end_);
    line = text_.substr(0, end);
    text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
    open_end_ = end == std::string_view::npos;
    while (line.ends_with('\r') || line.ends_with(' ')) line.remove_suffix(1);
    skip_space(line, " ");
    ++number_;
    return true;
  }
  std::size_t number() const { return number_; }
  /// Whether the text ended before the line did.
  bool at_open_end() const { return open_end_; }

 private:
  std::string_view text_;
  char line_end_;
  bool open_end_ = false;
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

std::vector<std::string> cells_of(std::string_view line, char separator) {
  std::vector<std::string> result;
  Cells cells(line, separator);
  for (std::string_view cell; result.size() <= most_columns && cells.next(cell);) result.emplace_back(cell);
  while (!result.empty() && result.back().empty()) result.pop_back();  // a separator at the end of the line
  return result;
}

std::string_view without_mark(std::string_view line) {
  while (line.starts_with('#')) line.remove_prefix(1);
  skip_space(line, " ");
  return line;
}

/// What a line such as "Time: 0.25 s", "# t = 0.25" or "# frame 3" says.
struct TimeRemark {
  bool is_step = false;
  double value = 0;  ///< s; of steps: which
};

std::optional<TimeRemark> time_in_line(std::string_view line) {
  constexpr std::size_t longest_name = 40;
  line = without_mark(line);
  const std::size_t end = line.find_first_of(":=,;0123456789+-");
  if (end == 0 || end > longest_name) return std::nullopt;
  std::string name(line.substr(0, end));
  std::erase(name, '"');
  const auto meaning = time_name(name);
  if (!meaning) return std::nullopt;
  line.remove_prefix(end);
  skip_space(line, " \t:=,;\"");
  double value = 0;
  if (!take_number(line, value) || !std::isfinite(value)) return std::nullopt;
  return TimeRemark{meaning->is_step, meaning->is_step ? value : value * meaning->unit};
}

/// Values of one column.
struct CsvColumn {
  std::string name;
  bool is_id = false;
  std::vector<double> values;
  std::vector<std::uint64_t> ids;
  std::string fault;
};

class CsvParser {
 public:
  CsvParser(std::string_view bytes, const std::string& name) : name_(name), lines_(bytes) {}

  ParticleTable parse() {
    find_names();
    std::string_view line;
    while (lines_.next(line)) {
      if (line.empty()) continue;
      if (line.front() != '#') {
        begin_step();
        read_row(line);
      } else if (const auto remark = time_in_line(line); remark && (!pending_ || pending_->is_step)) {
        pending_ = remark;
      }
    }
    ParticleTable table;
    table.format = "CSV";
    table.count = rows_;
    for (CsvColumn& column : columns_) add_column(table, column);
    if (remark_ && !remark_->is_step && remarked_.empty()) table.time = remark_->value;
    if (!remarked_.empty()) add_remarked_steps(table);
    return table;
  }

 private:
  [[noreturn]] void fail(std::size_t line, const std::string& message) const {
    throw InputError(fmt::format("{}, line {}: {}", name_, line, message));
  }

  /// The first line with names of positions, behind a # or not, within the first lines; where there is none, the first
  /// line without numbers. What stands before is a preface.
  void find_names() {
    Lines lines = lines_;
    std::string_view line;
    for (std::size_t k = 0; k < longest_preface && lines.next(line); ++k) {
      const std::string_view words = without_mark(line);
      if (const auto remark = time_in_line(line); remark && (!remark_ || remark_->is_step)) remark_ = remark;
      if (words.empty() || !names_positions(cells_of(words, find_separator(words)))) continue;
      take_names(words, lines.number());
      lines_ = lines;
      return;
    }
    remark_.reset();
    for (lines = lines_; lines.next(line);) {
      if (line.empty() || line.front() == '#') continue;
      const std::vector<std::string> cells = cells_of(line, find_separator(line));
      if (std::any_of(cells.begin(), cells.end(), [](const std::string& cell) { return is_number(cell); }))
        fail(lines.number(), "expected column names, such as x,y,z,vx,vy,vz,id, but there are numbers");
      take_names(line, lines.number());
      lines_ = lines;
      return;
    }
    throw InputError(name_ + ": there is no line of column names, such as x,y,z,vx,vy,vz,id; the file is empty");
  }

  void take_names(std::string_view line, std::size_t number) {
    names_line_ = number;
    separator_ = find_separator(line);
    const std::vector<std::string> names = cells_of(line, separator_);
    if (names.size() > most_columns) fail(number, "there are more than 4096 columns; this is no particle table");
    for (const std::string& name : names) columns_.push_back({name, is_id_name(name), {}, {}, {}});
  }

  /// A row after a remark about time: it begins another time step, or the first.
  void begin_step() {
    if (!pending_) return;
    const TimeRemark remark = *std::exchange(pending_, std::nullopt);
    if (rows_ > 0 && !remark_)
      fail(lines_.number(),
           "a remark about time stands before this row, but none before the first row: what is its time?");
    if (remark_ && remark_->is_step != remark.is_step) return;
    if (rows_ > 0) remarked_.resize(rows_, remark_->value);
    remark_ = remark;
  }

  void add_remarked_steps(ParticleTable& table) {
    remarked_.resize(rows_, remark_->value);
    const std::string name = remark_->is_step ? "step" : "time";
    if (!table.columns.contains(name)) table.columns[name] = std::move(remarked_);
  }

  void read_row(std::string_view line) {
    Cells cells(line, separator_);
    std::size_t k = 0;
    for (std::string_view cell; k < columns_.size() && cells.next(cell); ++k) read_cell(columns_[k], cell);
    std::string_view surplus;
    if (cells.next(surplus) && (!surplus.empty() || cells.next(surplus)))
      fail(lines_.number(), fmt::format("more values where line {} has {} column names", names_line_, columns_.size()));
    const std::size_t found = k;
    if (k < columns_.size() && lines_.at_open_end())
      fail(lines_.number(),
           fmt::format("{} values where line {} has {} column names, and the file ends within this line: "
                       "it is truncated",
                       found, names_line_, columns_.size()));
    for (; k < columns_.size(); ++k) {
      columns_[k].values.push_back(std::nan(""));
      columns_[k].ids.clear();
      note(columns_[k], fmt::format("{} values where line {} has {} column names; the file may be truncated", found,
                                    names_line_, columns_.size()));
    }
    ++rows_;
  }

  void read_cell(CsvColumn& column, std::string_view cell) {
    const auto value = separator_ == ',' ? number_of_word(cell) : number_with_comma(cell);
    if (!value) {
      const bool comma = cell.find(',') != std::string_view::npos;
      note(column, fmt::format("expected a number as \"{}\", found \"{}\"{}", column.name, cell.substr(0, 40),
                               comma ? "; numbers are written with a point, not a comma" : ""));
    }
    column.values.push_back(value ? *value : std::nan(""));
    if (!column.is_id || column.ids.size() + 1 != column.values.size()) return;
    if (const auto id = whole_number_of_word(cell)) column.ids.push_back(*id);
  }

  void note(CsvColumn& column, const std::string& what) const {
    if (column.fault.empty()) column.fault = fmt::format("line {}: {}", lines_.number(), what);
  }

  void add_column(ParticleTable& table, CsvColumn& column) const {
    if (column.name.empty()) return;
    if (table.columns.contains(column.name))
      return note_fault(table, column.name,
                        fmt::format("line {}: the column \"{}\" is there twice", names_line_, column.name));
    if (!column.fault.empty()) note_fault(table, column.name, column.fault);
    if (column.is_id && column.ids.size() == rows_) table.ids[column.name] = std::move(column.ids);
    table.columns[column.name] = std::move(column.values);
  }

  const std::string& name_;
  Lines lines_;
  std::size_t names_line_ = 0, rows_ = 0;
  char separator_ = ',';
  std::vector<CsvColumn> columns_;
  std::optional<TimeRemark> remark_, pending_;  // of the present step, of the next
  std::vector<double> remarked_;                // of each row of the steps so far, where remarks stand between rows
};

}  // namespace

ParticleTable parse_csv(std::string_view bytes, const std::string& name) { return CsvParser(bytes, name).parse(); }

}  // namespace flowskin::scenes
