#include "scenes/io/time_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include "common/number_text.h"
#include "scenes/io/number_words.h"
#include "scenes/io/particle_columns.h"

namespace flowskin::scenes {
namespace {

constexpr double never = 0;  // a unit that is none

/// What a unit of time is in seconds; `never` where the word is none.
double unit_of_time(std::string_view word) {
  constexpr std::array<std::pair<std::string_view, double>, 20> units{{{"s", 1},
                                                                       {"sec", 1},
                                                                       {"secs", 1},
                                                                       {"second", 1},
                                                                       {"seconds", 1},
                                                                       {"ms", 1e-3},
                                                                       {"msec", 1e-3},
                                                                       {"millisecond", 1e-3},
                                                                       {"milliseconds", 1e-3},
                                                                       {"us", 1e-6},
                                                                       {"microseconds", 1e-6},
                                                                       {"ns", 1e-9},
                                                                       {"ps", 1e-12},
                                                                       {"fs", 1e-15},
                                                                       {"min", 60},
                                                                       {"minutes", 60},
                                                                       {"h", 3600},
                                                                       {"hours", 3600},
                                                                       {"d", 86400},
                                                                       {"days", 86400}}};
  const auto* found = std::find_if(units.begin(), units.end(), [&](const auto& unit) { return unit.first == word; });
  return found == units.end() ? never : found->second;
}

/// What stands in the last brackets, in small letters; µ as u.
std::string in_brackets(const std::string& name) {
  const std::size_t end = name.find_last_of("])");
  const std::size_t start = end == std::string::npos ? end : name.find_last_of("[(", end);
  if (start == std::string::npos) return {};
  std::string unit = name.substr(start + 1, end - start - 1);
  for (const std::string_view micro : {"\xC2\xB5", "\xCE\xBC", "\xB5"})
    if (unit.starts_with(micro)) unit.replace(0, micro.size(), "u");
  return plain_column_name(unit);
}

template <std::size_t size>
bool is_one_of(std::string_view word, const std::array<std::string_view, size>& words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

constexpr std::array<std::string_view, 4> sure_times{"time", "timevalue", "times", "simulationtime"};
constexpr std::array<std::string_view, 17> likely_times{
    "t",       "simtime", "physicaltime", "elapsedtime", "timeelapsed", "elapsed",
    "seconds", "sec",     "timestamp",    "frametime",   "currenttime", "zeit",
    "temps",   "tempo",   "tiempo",       "flowtime",    "solutiontime"};
constexpr std::array<std::string_view, 2> sure_steps{"timestep", "timesteps"};
constexpr std::array<std::string_view, 20> likely_steps{
    "step",   "steps",    "frame", "frames", "iteration", "iterations", "iter", "itr",     "it", "cycle",
    "cycles", "snapshot", "snap",  "tstep",  "tick",      "dump",       "nt",   "schritt", "ts", "outputstep"};
constexpr std::array<std::string_view, 9> counts_of{"number", "no",  "nr",    "num",    "id",
                                                    "index",  "idx", "count", "counter"};
constexpr std::array<std::string_view, 6> in_front{"i", "n", "sim", "simulation", "current", "output"};

bool is_step_word(std::string_view word) { return is_one_of(word, sure_steps) || is_one_of(word, likely_steps); }

/// "framenumber", "timeindex", "istep"
bool is_counted(std::string_view word) {
  for (const std::string_view end : counts_of) {
    if (!word.ends_with(end) || word.size() == end.size()) continue;
    const std::string_view start = word.substr(0, word.size() - end.size());
    if (start == "time" || (is_step_word(start) && start != "it" && start != "ts")) return true;
  }
  for (const std::string_view start : in_front)
    if (word.starts_with(start) && is_step_word(word.substr(start.size()))) return true;
  return false;
}

std::string without_joints(std::string plain) {
  std::erase(plain, '_');
  return plain;
}

/// Without a unit.
std::optional<TimeName> time_word(const std::string& plain) {
  const std::string word = without_joints(plain);
  if (is_one_of(word, sure_times)) return TimeName{false, true};
  if (is_one_of(word, likely_times)) return TimeName{false, false};
  if (is_one_of(word, sure_steps)) return TimeName{true, true};
  if (is_one_of(word, likely_steps) || is_counted(word)) return TimeName{true, false};
  return std::nullopt;
}

}  // namespace

std::optional<TimeName> time_name(const std::string& name) {
  const std::string plain = plain_column_name(name);
  double unit = unit_of_time(in_brackets(name));
  std::optional<TimeName> found = time_word(plain);
  if (!found) {
    const std::size_t joint = plain.rfind('_');
    if (joint == std::string::npos) return std::nullopt;
    found = time_word(plain.substr(0, joint));
    unit = unit_of_time(plain.substr(joint + 1));
    if (!found || found->is_step || unit == never) return std::nullopt;
  }
  if (unit != never && !found->is_step) found->unit = unit;
  return found;
}

namespace {

using RowsByValue = std::map<double, std::vector<std::size_t>>;
using IdList = std::vector<std::uint64_t>;

/// A column that may tell time steps apart.
struct TimeColumn {
  std::string name;
  TimeName meaning;
  RowsByValue rows;        ///< By value.
  bool in_blocks = false;  ///< The rows of each value follow one another, the values ascend.
  bool separates = false;  ///< RowsByValue of the same value have different ids, though ids are repeated in the table.
};

RowsByValue rows_by_value(const std::vector<double>& values) {
  RowsByValue rows;
  for (std::size_t i = 0; i < values.size(); ++i) rows[values[i]].push_back(i);
  return rows;
}

bool is_usable(const ParticleTable& table, const std::string& name) {
  const std::vector<double>& values = table.columns.at(name);
  return !table.faults.contains(name) &&
         std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

bool ascends(const std::vector<double>& values) { return std::is_sorted(values.begin(), values.end()); }

/// By the order of rows: those of one value after one another.
bool are_blocks(const std::vector<double>& values, const RowsByValue& rows) {
  std::size_t changes = 0;
  for (std::size_t i = 1; i < values.size(); ++i) changes += values[i] != values[i - 1];
  return changes + 1 == rows.size();
}

bool are_repeated(IdList ids) {
  std::sort(ids.begin(), ids.end());
  return std::adjacent_find(ids.begin(), ids.end()) != ids.end();
}

/// Whether the rows of each value have different ids.
bool tells_apart(const RowsByValue& rows, const IdList& ids) {
  return std::all_of(rows.begin(), rows.end(), [&](const auto& value) {
    IdList some;
    for (const std::size_t i : value.second) some.push_back(ids[i]);
    return !are_repeated(std::move(some));
  });
}

/// The ids of all rows; empty where there are none that can be compared.
IdList ids_of(const ParticleTable& table) {
  for (const auto& [name, values] : table.columns) {
    if (!is_id_name(name) || !is_usable(table, name)) continue;
    if (const auto exact = table.ids.find(name); exact != table.ids.end()) return exact->second;
    IdList ids;
    for (const double value : values) {
      const auto id = whole_number_of(value);
      if (!id) return {};
      ids.push_back(*id);
    }
    return ids;
  }
  return {};
}

/// All whole: then steps are counted; else a step's name was given to times.
bool are_whole(const RowsByValue& rows) {
  return std::all_of(rows.begin(), rows.end(),
                     [](const auto& value) { return value.first >= 0 && whole_number_of(value.first).has_value(); });
}

/// Half of the rows have a value of their own: that is no step.
bool are_steps(const RowsByValue& rows, std::size_t count) { return rows.size() >= 2 && 2 * rows.size() <= count; }

std::vector<TimeColumn> time_columns(const ParticleTable& table, const IdList& ids) {
  std::vector<TimeColumn> found;
  const bool repeated = are_repeated(ids);
  for (const auto& [name, values] : table.columns) {
    const auto meaning = time_name(name);
    if (!meaning || !is_usable(table, name)) continue;
    TimeColumn column{name, *meaning, rows_by_value(values)};
    if (!are_steps(column.rows, table.count)) continue;
    column.in_blocks = ascends(values) || (meaning->is_sure && are_blocks(values, column.rows));
    column.separates = repeated && tells_apart(column.rows, ids);
    if (meaning->is_step && !are_whole(column.rows)) column.meaning.is_step = false;
    found.push_back(std::move(column));
  }
  return found;
}

/// Whether the name and the rows leave no doubt.
bool is_believed(const TimeColumn& column, const IdList& ids, TableKind kind) {
  if (column.separates) return true;
  if (kind == TableKind::arrays) return false;
  return column.meaning.is_sure || (column.in_blocks && (ids.empty() || are_repeated(ids)));
}

/// The more steps the better: times are rounded where they are written. Times rather than numbers of steps.
bool is_better(const TimeColumn& a, const TimeColumn& b) {
  const auto rank = [](const TimeColumn& c) {
    return std::tuple(c.separates, c.rows.size(), !c.meaning.is_step, c.meaning.is_sure);
  };
  return rank(a) > rank(b);
}

ParticleTable some_rows(const ParticleTable& table, const std::vector<std::size_t>& places) {
  ParticleTable step;
  step.format = table.format;
  step.count = places.size();
  step.faults = table.faults;
  step.radius = table.radius;
  for (const auto& [name, values] : table.columns) {
    std::vector<double>& some = step.columns[name];
    some.reserve(places.size());
    for (const std::size_t i : places) some.push_back(values[i]);
  }
  for (const auto& [name, ids] : table.ids)
    for (const std::size_t i : places) step.ids[name].push_back(ids[i]);
  return step;
}

std::vector<ParticleTable> split(const ParticleTable& table, const TimeColumn& column) {
  std::vector<ParticleTable> steps;
  for (const auto& [value, places] : column.rows) {
    steps.push_back(some_rows(table, places));
    if (column.meaning.is_step)
      steps.back().step = whole_number_of(value);
    else
      steps.back().time = value * column.meaning.unit;
  }
  steps.front().notes = table.notes;
  steps.front().notes.push_back(fmt::format("the column \"{}\" tells {} time steps apart{}", column.name, steps.size(),
                                            column.meaning.is_step || column.meaning.unit == 1
                                                ? ""
                                                : fmt::format("; its unit is taken for {:g} s", column.meaning.unit)));
  return steps;
}

/// A time that is the same in all rows is that of the table.
void take_constant_time(ParticleTable& table) {
  for (const auto& [name, values] : table.columns) {
    const auto meaning = time_name(name);
    if (!meaning || values.empty() || table.faults.contains(name) || !std::isfinite(values.front())) continue;
    const bool constant =
        std::all_of(values.begin(), values.end(), [first = values.front()](double v) { return v == first; });
    if (meaning->is_step && constant && !table.step && are_whole({{values.front(), {}}}))
      table.step = whole_number_of(values.front());
    if (!meaning->is_step && (constant || meaning->is_sure) && (!table.time || meaning->is_sure))
      table.time = values.front() * meaning->unit;
  }
}

/// Columns that count evenly over blocks of rows, but have no name of time.
std::string unnamed_counter(const ParticleTable& table) {
  constexpr std::size_t fewest = 3;
  constexpr std::array<std::string_view, 16> kinds{"type",   "kind",    "phase",  "material",  "mk",      "body",
                                                   "object", "species", "group",  "label",     "element", "block",
                                                   "rank",   "region",  "bodyid", "materialid"};
  for (const auto& [name, values] : table.columns) {
    const std::string plain = plain_column_name(name);
    if (is_id_name(name) || is_property_name(name) || is_one_of(without_joints(plain), kinds) ||
        !is_usable(table, name) || !ascends(values))
      continue;
    const RowsByValue rows = rows_by_value(values);
    if (rows.size() < fewest || !are_steps(rows, table.count)) continue;
    const std::size_t first = rows.begin()->second.size();
    if (std::all_of(rows.begin(), rows.end(), [&](const auto& value) { return value.second.size() == first; }))
      return name;
  }
  return {};
}

/// What looks like time steps and is taken for one.
void note_doubts(ParticleTable& table, const std::vector<TimeColumn>& columns, const IdList& ids, TableKind kind) {
  for (const TimeColumn& column : columns)
    if (kind == TableKind::text && column.in_blocks && !ids.empty() && !are_repeated(ids))
      table.notes.push_back(
          fmt::format("the column \"{}\" has {} values, but no id is there twice: this is taken for one time step",
                      column.name, column.rows.size()));
  if (kind != TableKind::text || !ids.empty()) return;
  if (const std::string name = unnamed_counter(table); !name.empty())
    table.notes.push_back(fmt::format(
        "the column \"{0}\" counts in blocks of rows of the same length. If these are time steps, call it \"time\" or "
        "\"step\": now all rows are taken for one step; --keep '{1} == {2}' would choose one",
        name, name.find_first_of(" -+*/") == std::string::npos ? name : '"' + name + '"',
        number_text(table.columns.at(name).front())));
}

}  // namespace

std::vector<ParticleTable> steps_by_time_column(ParticleTable table, TableKind kind) {
  std::vector<ParticleTable> steps;
  const bool has_name = std::any_of(table.columns.begin(), table.columns.end(),
                                    [](const auto& column) { return time_name(column.first).has_value(); });
  if (has_name || kind == TableKind::text) {
    const IdList ids = ids_of(table);
    const std::vector<TimeColumn> columns = time_columns(table, ids);
    const TimeColumn* best = nullptr;
    for (const TimeColumn& column : columns)
      if (is_believed(column, ids, kind) && (best == nullptr || is_better(column, *best))) best = &column;
    if (best != nullptr) return split(table, *best);
    note_doubts(table, columns, ids, kind);
    if (kind == TableKind::text) take_constant_time(table);
  }
  steps.push_back(std::move(table));
  return steps;
}

std::string column_that_separates(const ParticleTable& table, const std::vector<std::uint64_t>& ids) {
  std::string best;
  std::size_t fewest = table.count;
  if (ids.size() != table.count) return best;
  for (const auto& [name, values] : table.columns) {
    if (is_id_name(name) || is_property_name(name) || !is_usable(table, name)) continue;
    const RowsByValue rows = rows_by_value(values);
    if (rows.size() < 2 || rows.size() >= fewest || !tells_apart(rows, ids)) continue;
    best = name;
    fewest = rows.size();
  }
  return best;
}

}  // namespace flowskin::scenes
