// Particles from named columns, whoever wrote them.
#include "scenes/io/particle_columns.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <numeric>
#include <set>
#include <utility>

#include "common/errors.h"
#include "common/number_text.h"
#include "scenes/io/number_words.h"
#include "scenes/io/ply_reader.h"
#include "scenes/io/row_filter.h"
#include "scenes/io/time_columns.h"

namespace flowskin::scenes {
namespace {

/// Of positions (m) and velocities (m/s): map coordinates and light are within it, and nothing that can be tracked is
/// beyond.
constexpr double largest_value = 1e9;
/// What is written is single precision.
constexpr double largest_density = 1e30;

using Column = std::vector<double>;
using Names = std::initializer_list<const char*>;

/// A column that may be called in several ways.
struct NamedColumn {
  std::string written;  ///< its name in the file
  const Column* values = nullptr;
  std::string other;  ///< another column of the same plain name
};
/// By plain name.
using Columns = std::map<std::string, NamedColumn>;

const Names position_names = {"", "position", "positions", "pos", "points", "point", "p", "coordinates", "coords"};
const Names velocity_names = {"v", "velocity", "velocities", "vel"};
const Names rest_names = {"rest", "rest_position", "rest_positions", "restposition"};
const Names id_names = {"id",          "ids", "particle_id", "particle_ids", "particleid",
                        "particleids", "idp", "globalids",   "global_id"};
const Names radius_names = {"radius", "radii", "particle_radius", "pscale"};
const Names density_names = {"density", "densities", "rho", "rhop"};

/// Of two that differ in case or signs only, the one that is written plainly counts.
Columns columns_by_plain_name(const ParticleTable& table) {
  Columns columns;
  for (const auto& [written, values] : table.columns) {
    const std::string plain = plain_column_name(written);
    const auto [place, is_new] = columns.try_emplace(plain, NamedColumn{written, &values, ""});
    if (is_new) continue;
    NamedColumn& column = place->second;
    if (written == plain)
      column = {written, &values, ""};
    else if (column.written != plain)
      column.other = written;
  }
  return columns;
}

/// Finds what is needed in one table, and stops where that is at fault.
class ColumnFinder {
 public:
  ColumnFinder(const ParticleTable& table, const std::string& name)
      : table_(table), name_(name), columns_(columns_by_plain_name(table)) {}

  /// The column of the first of these names that is there, or nullptr; unchecked.
  const NamedColumn* find(Names names) const {
    for (const char* name : names)
      if (const auto found = columns_.find(name); found != columns_.end()) return &found->second;
    return nullptr;
  }

  bool is_faulty(const NamedColumn& column) const {
    return !column.other.empty() || table_.faults.contains(column.written);
  }

  /// @throws InputError where the column is at fault
  void require(const NamedColumn& column) const {
    if (!column.other.empty())
      throw InputError(fmt::format("{}: two columns are called \"{}\" but for signs, case and units: \"{}\" and \"{}\"",
                                   name_, plain_column_name(column.written), column.written, column.other));
    if (const auto fault = table_.faults.find(column.written); fault != table_.faults.end())
      throw InputError(fmt::format("{}, {}", name_, fault->second));
  }

  /// Three columns such as vx vy vz, vel_x vel_y vel_z, velocity_0 velocity_1 velocity_2; null where they are not
  /// there.
  /// @throws InputError where only some of the three are there, or one is at fault.
  std::array<const Column*, 3> find_vector(Names names, const std::string& what) const {
    for (const std::string base : names) {
      for (const char* components : {"xyz", "012"}) {
        for (const char* joint : {"", "_"}) {
          if (base.empty() && (components[0] != 'x' || joint[0] != '\0')) continue;
          const auto triple = find_triple(base + joint, components);
          const auto present = std::count_if(triple.begin(), triple.end(), [](const auto* c) { return c != nullptr; });
          if (present == 3) {
            for (const NamedColumn* column : triple) require(*column);
            return {triple[0]->values, triple[1]->values, triple[2]->values};
          }
          // A lone "p0" or "v_x" may be anything; of the plain names and of two in three it is a slip.
          if (present == 2 || (present == 1 && joint[0] == '\0' && components[0] == 'x')) complain(triple, what);
        }
      }
    }
    return {};
  }

 private:
  std::array<const NamedColumn*, 3> find_triple(const std::string& base, const char* components) const {
    std::array<const NamedColumn*, 3> triple{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto found = columns_.find(base + components[k]);
      if (found != columns_.end()) triple[k] = &found->second;
    }
    return triple;
  }

  [[noreturn]] void complain(const std::array<const NamedColumn*, 3>& triple, const std::string& what) const {
    if (what == "position" && triple[0] != nullptr && triple[1] != nullptr)
      throw InputError(fmt::format(
          "{}: there are \"{}\" and \"{}\", but no third coordinate: these are data in two dimensions, and a surface "
          "needs three. Repeat the particles in several layers, with z = 0, h, 2 h, ... 5 h, h being their spacing",
          name_, triple[0]->written, triple[1]->written));
    throw InputError(name_ + ": only some components of the " + what + " are there; x, y and z were expected");
  }

  const ParticleTable& table_;
  const std::string& name_;
  Columns columns_;
};

using Triple = std::array<const Column*, 3>;

/// Three columns as vectors; `fallback` where they are not there.
std::vector<Vec3> vectors(const Triple& columns, std::vector<Vec3> fallback, const std::string& what,
                          const std::string& unit, const std::string& name) {
  if (columns[0] == nullptr) return fallback;
  std::vector<Vec3> result(columns[0]->size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] = Vec3((*columns[0])[i], (*columns[1])[i], (*columns[2])[i]);
    if (!result[i].allFinite())
      throw InputError(name + ", particle " + std::to_string(i + 1) + ": the " + what +
                       " is not finite; --skip-invalid leaves such particles out");
    if (const double most = result[i].cwiseAbs().maxCoeff(); most > largest_value)
      throw InputError(
          fmt::format("{}, particle {}: the {} has a component of {:.4g} {}, more than {:g}; is that so? --region and "
                      "--skip-invalid leave such particles out",
                      name, i + 1, what, most, unit, largest_value));
  }
  return result;
}

/// @param column nullptr: the order in the file
std::vector<std::uint64_t> particle_ids(const ParticleTable& table, const NamedColumn* column,
                                        const std::string& name) {
  std::vector<std::uint64_t> ids(table.count);
  if (column == nullptr) {
    std::iota(ids.begin(), ids.end(), std::uint64_t{0});
    return ids;
  }
  if (const auto exact = table.ids.find(column->written); exact != table.ids.end()) return exact->second;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const auto id = whole_number_of((*column->values)[i]);
    if (!id)
      throw InputError(fmt::format("{}, particle {}: its id is no whole number (\"{}\"); --no-ids does without ids",
                                   name, i + 1, column->written));
    ids[i] = *id;
  }
  return ids;
}

template <class T>
std::vector<T> reordered(const std::vector<T>& values, const std::vector<std::size_t>& order) {
  std::vector<T> result;
  result.reserve(order.size());
  for (const std::size_t i : order) result.push_back(values[i]);
  return result;
}

/// @throws InputError where an id is there twice, in several time steps perhaps.
[[noreturn]] void refuse_twins(std::uint64_t id, const ParticleTable& table, const std::vector<std::uint64_t>& ids,
                               const std::string& name) {
  if (const std::string column = column_that_separates(table, ids); !column.empty())
    throw InputError(fmt::format(
        "{}: two particles have the id {}, but not the same \"{}\": the file seems to hold several time steps. If "
        "\"{}\" tells them apart, call it \"time\" (s) or \"step\"; or choose one, as by --keep '\"{}\" == {}'",
        name, id, column, column, column, number_text(table.columns.at(column).front())));
  throw InputError(fmt::format(
      "{}: two particles have the id {}: every particle needs its own, the same in every file of a sequence; "
      "--skip-duplicates keeps the first, --no-ids does without ids",
      name, id));
}

/// @throws InputError where an id is there twice.
void sort_by_id(ParticleState& state, const ParticleTable& table, const std::string& name) {
  std::vector<std::size_t> order(state.ids.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return state.ids[a] < state.ids[b]; });
  const std::vector<std::uint64_t> in_file = std::exchange(state.ids, reordered(state.ids, order));
  const auto twice = std::adjacent_find(state.ids.begin(), state.ids.end());
  if (twice != state.ids.end()) refuse_twins(*twice, table, in_file, name);
  state.positions = reordered(state.positions, order);
  state.velocities = reordered(state.velocities, order);
  state.rest_positions = reordered(state.rest_positions, order);
  state.densities = reordered(state.densities, order);
}

/// Median of those that are finite and positive; 0 where there are none.
double median_radius(const NamedColumn* column) {
  Column radii;
  if (column != nullptr)
    std::copy_if(column->values->begin(), column->values->end(), std::back_inserter(radii),
                 [](double radius) { return std::isfinite(radius) && radius > 0; });
  if (radii.empty()) return 0;
  const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
  std::nth_element(radii.begin(), middle, radii.end());
  return *middle;
}

/// Of all particles, or 0 for all: nothing depends on them but what is written.
Column usable_densities(const NamedColumn* column, bool is_faulty, std::size_t count) {
  const bool usable = column != nullptr && !is_faulty &&
                      std::all_of(column->values->begin(), column->values->end(),
                                  [](double density) { return std::abs(density) <= largest_density; });
  return usable ? *column->values : Column(count, 0.0);
}

}  // namespace

LeftOut& LeftOut::operator+=(const LeftOut& other) {
  by_keep += other.by_keep;
  by_region += other.by_region;
  invalid += other.invalid;
  duplicate += other.duplicate;
  stray += other.stray;
  return *this;
}

std::string left_out_text(const LeftOut& left_out) {
  std::string text;
  for (const auto& [count, by] :
       {std::pair(left_out.by_keep, "by --keep"), std::pair(left_out.by_region, "by --region"),
        std::pair(left_out.invalid, "by --skip-invalid"), std::pair(left_out.duplicate, "by --skip-duplicates"),
        std::pair(left_out.stray, "too far from all others")})
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, by);
  return text;
}

std::string plain_column_name(const std::string& name) {
  const auto is_component = [](const std::string& text) {
    return text.size() == 1 && std::string("xyzXYZ012").find(text[0]) != std::string::npos;
  };
  std::string plain;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const char c = name[i];
    if (c == '[' || c == '(') {  // a unit, unless it names a component, as in P[0]
      const std::size_t end = name.find(c == '[' ? ']' : ')', i);
      if (end != std::string::npos && !is_component(name.substr(i + 1, end - i - 1))) {
        i = end;
        continue;
      }
    }
    const bool is_letter = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    if (c >= 'A' && c <= 'Z') {
      plain += static_cast<char>(c - 'A' + 'a');
    } else if (is_letter) {
      plain += c;
    } else if (!plain.empty() && plain.back() != '_') {
      plain += '_';
    }
  }
  while (!plain.empty() && plain.back() == '_') plain.pop_back();
  return plain;
}

bool is_id_name(const std::string& name) {
  const std::string plain = plain_column_name(name);
  return std::any_of(id_names.begin(), id_names.end(), [&](const char* id) { return plain == id; });
}

bool is_velocity_name(const std::string& name) {
  const std::string plain = plain_column_name(name);
  return std::any_of(velocity_names.begin(), velocity_names.end(), [&](const std::string base) {
    if (plain == base) return true;
    for (const char* joint : {"", "_"})
      for (const char axis : std::string("xyz012"))
        if (plain == base + joint + axis) return true;
    return false;
  });
}

bool is_property_name(const std::string& name) {
  const std::string plain = plain_column_name(name);
  const auto is_of = [&](Names names, bool is_vector) {
    return std::any_of(names.begin(), names.end(), [&](const std::string base) {
      if (!is_vector) return plain == base;
      for (const char* joint : {"", "_"})
        for (const char axis : std::string("xyz012"))
          if (plain == base + joint + axis && (!base.empty() || *joint == '\0')) return true;
      return false;
    });
  };
  return is_of(position_names, true) || is_of(velocity_names, true) || is_of(rest_names, true) ||
         is_of(radius_names, false) || is_of(density_names, false);
}

bool names_positions(const std::vector<std::string>& names) {
  std::set<std::string> plain;
  for (const std::string& name : names) plain.insert(plain_column_name(name));
  return std::any_of(position_names.begin(), position_names.end(), [&](const std::string base) {
    for (const char* joint : {"", "_"}) {
      if (plain.contains(base + joint + "x") && plain.contains(base + joint + "y") && (!base.empty() || *joint == '\0'))
        return true;
      if (!base.empty() && plain.contains(base + joint + "0") && plain.contains(base + joint + "1")) return true;
    }
    return false;
  });
}

namespace {

bool has_selection(const ParticleNeeds& needs) {
  return !needs.keep.empty() || needs.region || needs.skip_invalid || needs.skip_duplicates;
}

/// The rows that are left of `table`; `count` grows by those that are not.
ParticleTable without_rows(const ParticleTable& table, const std::vector<char>& wanted, std::uint64_t& count) {
  const ParticleTable rows = rows_of(table, wanted);
  count += table.count - rows.count;
  return rows;
}

/// Which particles have finite values within bounds in all columns that are needed.
std::vector<char> valid_rows(const ParticleTable& table, const std::string& name, const ParticleNeeds& needs) {
  const ColumnFinder columns(table, name);
  std::vector<char> valid(table.count, 1);
  for (const auto& [names, what] : {std::pair(position_names, "position"), std::pair(velocity_names, "velocity"),
                                    std::pair(rest_names, "rest position")})
    for (const Column* column : columns.find_vector(names, what))
      for (std::size_t i = 0; column != nullptr && i < valid.size(); ++i)
        valid[i] = valid[i] && std::abs((*column)[i]) <= largest_value;
  const NamedColumn* ids = needs.ids ? columns.find(id_names) : nullptr;
  if (ids != nullptr && !table.ids.contains(ids->written))
    for (std::size_t i = 0; i < valid.size(); ++i)
      valid[i] = valid[i] && whole_number_of((*ids->values)[i]).has_value();
  return valid;
}

std::vector<char> rows_in(const sph::Box& region, const ParticleTable& table, const std::string& name) {
  const Triple place = ColumnFinder(table, name).find_vector(position_names, "position");
  std::vector<char> inside(table.count, 1);
  for (Eigen::Index k = 0; k < 3 && place[0] != nullptr; ++k)
    for (std::size_t i = 0; i < inside.size(); ++i) {
      const double x = (*place[static_cast<std::size_t>(k)])[i];
      // What is no number is not outside: it is an error, or left out as invalid.
      inside[i] = inside[i] && !(x < region.min[k] || x > region.max[k]);
    }
  return inside;
}

/// The first of each id and of each place.
std::vector<char> first_rows(const ParticleTable& table, const std::string& name, const ParticleNeeds& needs) {
  const ColumnFinder columns(table, name);
  const Triple place = columns.find_vector(position_names, "position");
  const NamedColumn* id = needs.ids ? columns.find(id_names) : nullptr;
  const std::vector<std::uint64_t> ids = particle_ids(table, id, name);
  std::set<std::uint64_t> seen_ids;
  std::set<std::array<double, 3>> seen_places;
  std::vector<char> first(table.count, 1);
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (!seen_ids.insert(ids[i]).second) first[i] = 0;
    if (place[0] == nullptr) continue;
    const std::array<double, 3> x{(*place[0])[i], (*place[1])[i], (*place[2])[i]};
    if (std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2]) && !seen_places.insert(x).second)
      first[i] = 0;
  }
  return first;
}

ParticleTable selected(const ParticleTable& all, const std::string& name, const ParticleNeeds& needs,
                       LeftOut& left_out) {
  ParticleTable table = all;
  if (needs.skip_invalid) table.faults.clear();  // what is at fault there is NaN
  if (!needs.keep.empty()) table = without_rows(table, rows_that(needs.keep, all, name), left_out.by_keep);
  if (needs.region) table = without_rows(table, rows_in(*needs.region, table, name), left_out.by_region);
  if (needs.skip_invalid) table = without_rows(table, valid_rows(table, name, needs), left_out.invalid);
  if (needs.skip_duplicates) table = without_rows(table, first_rows(table, name, needs), left_out.duplicate);
  return table;
}

}  // namespace

ParticleFile particles_from_table(const ParticleTable& all, const std::string& name, const ParticleNeeds& needs) {
  LeftOut left_out;
  const ParticleTable some = has_selection(needs) ? selected(all, name, needs, left_out) : ParticleTable();
  const ParticleTable& table = has_selection(needs) ? some : all;
  const ColumnFinder columns(table, name);
  const Triple place = columns.find_vector(position_names, "position");
  if (place[0] == nullptr) {
    std::vector<std::string> names;
    for (const auto& column : table.columns) names.push_back(column.first);
    throw InputError(
        fmt::format("{}: particles need the columns x, y and z; {}", name,
                    names.empty() ? "there are none" : fmt::format("there are: {}", fmt::join(names, ", "))));
  }
  const Triple velocity = columns.find_vector(velocity_names, "velocity");
  const Triple rest = columns.find_vector(rest_names, "rest position");
  const NamedColumn* ids = needs.ids ? columns.find(id_names) : nullptr;
  if (ids != nullptr) columns.require(*ids);
  const NamedColumn* densities = columns.find(density_names);

  ParticleFile file;
  file.left_out = left_out;
  file.has_ids = ids != nullptr;
  file.has_velocities = velocity[0] != nullptr;
  file.has_rest_positions = rest[0] != nullptr;
  file.radius = median_radius(columns.find(radius_names));
  if (file.radius == 0) file.radius = table.radius;
  ParticleState& state = file.state;
  state.ids = particle_ids(table, ids, name);
  state.positions = vectors(place, {}, "position", "m", name);
  state.velocities = vectors(velocity, std::vector<Vec3>(table.count, Vec3::Zero()), "velocity", "m/s", name);
  state.rest_positions = vectors(rest, state.positions, "rest position", "m", name);
  state.densities = usable_densities(densities, densities != nullptr && columns.is_faulty(*densities), table.count);
  if (file.has_ids) sort_by_id(state, table, name);
  return file;
}

ParticleState particles_from_ply(const std::filesystem::path& file) {
  return particles_from_ply(read_ply(file), file.string());
}

ParticleState particles_from_ply(const PlyFile& ply, const std::string& name) {
  return particles_from_table(table_from_ply(ply), name).state;
}

}  // namespace flowskin::scenes
