#include "scenes/io/join_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

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

}  // namespace flowskin::scenes
