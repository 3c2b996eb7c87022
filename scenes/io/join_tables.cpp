#include "scenes/io/join_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "scenes/io/number_words.h"
#include "scenes/io/particle_columns.h"
#include "scenes/io/row_filter.h"

namespace flowskin::scenes {
namespace {

ParticleTable without_ghosts(ParticleTable table) {
  const auto ghosts = table.columns.find("vtkGhostType");
  if (ghosts == table.columns.end() || table.faults.contains("vtkGhostType")) return table;
  std::vector<char> wanted(table.count);
  std::transform(ghosts->second.begin(), ghosts->second.end(), wanted.begin(), [](double mark) { return mark == 0; });
  return std::find(wanted.begin(), wanted.end(), char{0}) == wanted.end() ? std::move(table) : rows_of(table, wanted);
}

/// The name of the column whose values are times or numbers of steps; empty where there is none.
std::string time_column(const ParticleTable& table) {
  for (const auto& wanted : {"time", "timevalue", "timestep", "time_step"})
    for (const auto& [name, values] : table.columns)
      if (plain_column_name(name) == wanted && !table.faults.contains(name) &&
          std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); }))
        return name;
  return {};
}

}  // namespace

void append_part(ParticleTable& whole, ParticleTable part) {
  part = without_ghosts(std::move(part));
  if (whole.count == 0 && whole.columns.empty()) {
    whole = std::move(part);
    return;
  }
  const std::size_t before = whole.count;
  whole.count += part.count;
  whole.polygons += part.polygons;
  for (const auto& [column, fault] : part.faults) note_fault(whole, column, fault);
  for (auto& [name, values] : part.columns) {
    if (!whole.columns.contains(name) && before > 0)
      note_fault(whole, name, fmt::format("the column \"{}\" is not in every part", name));
    std::vector<double>& all = whole.columns[name];
    all.resize(before, std::nan(""));
    all.insert(all.end(), values.begin(), values.end());
  }
  for (auto& [name, values] : whole.columns) {
    if (values.size() == whole.count) continue;
    if (part.count > 0) note_fault(whole, name, fmt::format("the column \"{}\" is not in every part", name));
    values.resize(whole.count, std::nan(""));
  }
  for (const auto& [name, ids] : part.ids)
    if (const auto all = whole.ids.find(name); all != whole.ids.end() && all->second.size() == before)
      all->second.insert(all->second.end(), ids.begin(), ids.end());
  std::erase_if(whole.ids, [&](const auto& ids) { return ids.second.size() != whole.count; });
}

std::vector<ParticleTable> steps_by_time_column(ParticleTable table) {
  std::vector<ParticleTable> steps;
  const std::string column = time_column(table);
  std::map<double, std::vector<std::size_t>> rows;
  if (!column.empty() && !table.columns[column].empty()) {
    const std::vector<double>& times = table.columns[column];
    for (std::size_t i = 0; i < times.size(); ++i) rows[times[i]].push_back(i);
  }
  if (rows.size() < 2 || 2 * rows.size() > table.count) {
    steps.push_back(std::move(table));
    return steps;
  }
  const bool counts = plain_column_name(column).ends_with("step");
  for (const auto& [time, places] : rows) {
    ParticleTable step;
    step.format = table.format;
    step.count = places.size();
    step.faults = table.faults;
    step.radius = table.radius;
    for (const auto& [name, values] : table.columns)
      for (const std::size_t i : places) step.columns[name].push_back(values[i]);
    for (const auto& [name, ids] : table.ids)
      for (const std::size_t i : places) step.ids[name].push_back(ids[i]);
    if (!counts) step.time = time;
    if (counts) step.step = whole_number_of(time);
    steps.push_back(std::move(step));
  }
  return steps;
}

}  // namespace flowskin::scenes
