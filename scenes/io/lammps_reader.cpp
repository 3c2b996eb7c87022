#include "scenes/io/lammps_reader.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "common/number_text.h"
#include "scenes/io/number_words.h"
#include "scenes/io/text_columns.h"
#include "scenes/io/text_lines.h"

namespace flowskin::scenes {
namespace {

constexpr std::string_view lammps_item = "ITEM: ";
constexpr std::size_t most_lammps_columns = 4096;

/// Where scaled coordinates begin, and the box's edges (one a column).
struct LammpsBox {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Matrix3d edges = Eigen::Matrix3d::Identity();
};

class LammpsParser {
 public:
  LammpsParser(std::string_view bytes, const std::string& name) : lines_(bytes, name) {}

  std::vector<ParticleTable> parse() {
    std::vector<ParticleTable> steps;
    ParticleTable head;
    std::string_view line;
    while (lines_.next(line)) {
      if (line.find_first_not_of(" \t") == std::string_view::npos) continue;
      if (!line.starts_with(lammps_item))
        lines_.fail(fmt::format("expected ITEM: ..., found \"{}\"", line.substr(0, 40)));
      line.remove_prefix(lammps_item.size());
      if (line.starts_with("ATOMS")) {
        steps.push_back(read_atoms(line.substr(5), std::exchange(head, {})));
      } else {
        read_head(line, head);
      }
    }
    if (steps.empty() || head.step || count_) lines_.expect("ITEM: ATOMS");
    return steps;
  }

 private:
  void read_head(std::string_view what, ParticleTable& head) {
    if (what.starts_with("TIMESTEP")) {
      head.step = whole_number("the time step");
    } else if (what.starts_with("NUMBER OF ATOMS")) {
      count_ = whole_number("the number of atoms");
    } else if (what.starts_with("BOX BOUNDS")) {
      read_box(what.substr(10));
    } else if (what.starts_with("TIME")) {
      std::string_view line = lines_.expect("the time");
      head.time = number(line);
    } else if (what.starts_with("UNITS")) {
      lines_.expect("the units");
    } else {
      lines_.fail(fmt::format("ITEM: {} is not understood; expected TIMESTEP, NUMBER OF ATOMS, BOX BOUNDS or ATOMS",
                              what.substr(0, 40)));
    }
  }

  std::uint64_t whole_number(const char* what) {
    std::string_view line = lines_.expect(what);
    const std::string_view word = take_word(line);
    const auto value = whole_number_of_word(word);
    if (!value || word.starts_with('-'))
      lines_.fail(fmt::format("expected {}, found \"{}\"", what, word.substr(0, 40)));
    return *value;
  }

  double number(std::string_view& line) {
    const std::string_view word = take_word(line);
    const auto value = number_of_word(word);
    if (!value) lines_.fail(fmt::format("expected a number, found \"{}\"", word.substr(0, 40)));
    return *value;
  }

  /// Bounds lo and hi of each axis, with tilts xy, xz, yz where the box is triclinic ([LAMMPS, Howto triclinic]), or
  /// its edges and origin.
  void read_box(std::string_view kind) {
    LammpsBox box;
    if (kind.find("abc origin") != std::string_view::npos) {
      for (int axis = 0; axis < 3; ++axis) {
        std::string_view line = lines_.expect("an edge of the box");
        for (int k = 0; k < 3; ++k) box.edges(k, axis) = number(line);
        box.origin[axis] = number(line);
      }
      box_ = box;
      return;
    }
    const bool tilted = kind.find("xy") != std::string_view::npos;
    std::array<double, 3> low{}, high{}, tilt{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::string_view line = lines_.expect("bounds of the box");
      low[axis] = number(line);
      high[axis] = number(line);
      if (tilted) tilt[axis] = number(line);
    }
    const auto [xy, xz, yz] = tilt;
    low[0] -= std::min({0.0, xy, xz, xy + xz});
    high[0] -= std::max({0.0, xy, xz, xy + xz});
    low[1] -= std::min(0.0, yz);
    high[1] -= std::max(0.0, yz);
    box.origin = {low[0], low[1], low[2]};
    box.edges << high[0] - low[0], xy, xz, 0, high[1] - low[1], yz, 0, 0, high[2] - low[2];
    box_ = box;
  }

  ParticleTable read_atoms(std::string_view names_line, ParticleTable table) {
    if (!count_) lines_.fail("ITEM: ATOMS stands before ITEM: NUMBER OF ATOMS");
    std::vector<std::string> names;
    for (std::string_view word = take_word(names_line); !word.empty(); word = take_word(names_line))
      names.emplace_back(word);
    if (names.size() < 3 || names.size() > most_lammps_columns)
      lines_.fail("expected ITEM: ATOMS with the names of the columns, such as id x y z");
    TextColumns columns(names);
    const std::uint64_t count = *std::exchange(count_, std::nullopt);
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::string_view line = lines_.expect("an atom");
      if (const std::size_t found = columns.add_row(line, lines_.number()); found != columns.size())
        lines_.fail(fmt::format("atom {} of {} has {} values, {} were expected; the file may be truncated", i + 1,
                                count, found, columns.size()));
    }
    columns.move_into(table);
    table.format = "LAMMPS dump";
    settle_positions(table);
    return table;
  }

  /// x, y and z from what else tells the place.
  void settle_positions(ParticleTable& table) {
    const auto has = [&](const std::string& end) {
      return std::all_of(axis_names.begin(), axis_names.end(),
                         [&](const std::string axis) { return table.columns.contains(axis + end); });
    };
    if (has("")) return;
    if (has("u")) {
      for (const std::string axis : axis_names) take_column(table, axis, axis + "u");
      return;
    }
    for (const std::string end : {"s", "su"}) {
      if (!has(end)) continue;
      if (!box_) lines_.fail("scaled coordinates without ITEM: BOX BOUNDS");
      scale(table, end);
      return;
    }
  }

  static void take_column(ParticleTable& table, const std::string& to, const std::string& from) {
    table.columns[to] = table.columns[from];
    if (const auto fault = table.faults.find(from); fault != table.faults.end()) note_fault(table, to, fault->second);
  }

  void scale(ParticleTable& table, const std::string& end) const {
    std::array<std::vector<double>*, 3> columns{};
    for (std::size_t k = 0; k < 3; ++k) {
      take_column(table, axis_names[k], axis_names[k] + end);
      columns[k] = &table.columns[axis_names[k]];
    }
    for (std::size_t i = 0; i < table.count; ++i) {
      const Eigen::Vector3d share((*columns[0])[i], (*columns[1])[i], (*columns[2])[i]);
      const Eigen::Vector3d place = box_->origin + box_->edges * share;
      for (std::size_t k = 0; k < 3; ++k) (*columns[k])[i] = place[static_cast<Eigen::Index>(k)];
    }
  }

  static constexpr std::array<const char*, 3> axis_names{"x", "y", "z"};

  TextLines lines_;
  std::optional<std::uint64_t> count_;
  std::optional<LammpsBox> box_;
};

}  // namespace

bool is_lammps_dump(std::string_view bytes) { return bytes.starts_with(lammps_item); }

std::vector<ParticleTable> parse_lammps_dump(std::string_view bytes, const std::string& name) {
  return LammpsParser(bytes, name).parse();
}

}  // namespace flowskin::scenes
