// Particles from named columns, whoever wrote them.
#include "scenes/io/particle_columns.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <numeric>
#include <utility>

#include "common/errors.h"
#include "scenes/io/ply_reader.h"

namespace flowskin::scenes {
namespace {

/// Of positions (m) and velocities (m/s): map coordinates and light are within it, and nothing that can be tracked is
/// beyond.
constexpr double largest_value = 1e9;
/// What is written is single precision.
constexpr double largest_density = 1e30;

using Column = std::vector<double>;
using Names = std::initializer_list<const char*>;
/// Columns by plain name.
using Columns = std::map<std::string, const Column*>;

const Names position_names = {"", "position", "positions", "pos", "points", "point", "p", "coordinates", "coords"};
const Names velocity_names = {"v", "velocity", "velocities", "vel"};
const Names rest_names = {"rest", "rest_position", "rest_positions", "restposition"};
const Names id_names = {"id", "ids", "particle_id", "particle_ids", "particleid", "idp", "globalids", "global_id"};
const Names radius_names = {"radius", "radii", "particle_radius", "pscale"};
const Names density_names = {"density", "densities", "rho", "rhop"};

/// @throws InputError where two columns have the same plain name.
Columns columns_by_plain_name(const ParticleTable& table, const std::string& name) {
  Columns columns;
  for (const auto& [written, column] : table.columns) {
    if (!columns.emplace(plain_column_name(written), &column).second)
      throw InputError(fmt::format("{}: two columns are called \"{}\" (but for signs, case and units)", name,
                                   plain_column_name(written)));
  }
  return columns;
}

/// The column of the first of these names that is there, or nullptr.
const Column* find_column(const Columns& columns, Names names) {
  for (const char* name : names)
    if (const auto found = columns.find(name); found != columns.end()) return found->second;
  return nullptr;
}

using Triple = std::array<const Column*, 3>;

/// Three columns such as vx vy vz, vel_x vel_y vel_z, velocity_0 velocity_1 velocity_2; null where they are not there.
/// @throws InputError where only some of the three are there.
Triple find_vector(const Columns& columns, Names names, const std::string& what, const std::string& name) {
  for (const std::string base : names) {
    for (const char* components : {"xyz", "012"}) {
      for (const char* joint : {"", "_"}) {
        if (base.empty() && (components[0] != 'x' || joint[0] != '\0')) continue;
        Triple triple{};
        for (std::size_t k = 0; k < 3; ++k) {
          const auto found = columns.find(base + joint + components[k]);
          if (found != columns.end()) triple[k] = found->second;
        }
        const auto present = std::count_if(triple.begin(), triple.end(), [](const Column* c) { return c != nullptr; });
        if (present == 3) return triple;
        // A lone "p0" or "v_x" may be anything; of the plain names and of two in three it is a slip.
        if (present == 2 || (present == 1 && joint[0] == '\0' && components[0] == 'x'))
          throw InputError(name + ": only some components of the " + what + " are there; x, y and z were expected");
      }
    }
  }
  return {};
}

/// Three columns as vectors; `fallback` where they are not there.
std::vector<Vec3> vectors(const Triple& columns, std::vector<Vec3> fallback, const std::string& what,
                          const std::string& unit, const std::string& name) {
  if (columns[0] == nullptr) return fallback;
  std::vector<Vec3> result(columns[0]->size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] = Vec3((*columns[0])[i], (*columns[1])[i], (*columns[2])[i]);
    if (!result[i].allFinite())
      throw InputError(name + ", particle " + std::to_string(i + 1) + ": the " + what + " is not finite");
    if (const double most = result[i].cwiseAbs().maxCoeff(); most > largest_value)
      throw InputError(fmt::format("{}, particle {}: the {} has a component of {:.4g} {}, more than {:g}; is that so?",
                                   name, i + 1, what, most, unit, largest_value));
  }
  return result;
}

std::vector<std::uint64_t> particle_ids(const Column* column, std::size_t count, const std::string& name) {
  std::vector<std::uint64_t> ids(count);
  if (column == nullptr) {
    std::iota(ids.begin(), ids.end(), std::uint64_t{0});
    return ids;
  }
  constexpr double largest_exact = 9007199254740992.0;  // 2^53: beyond it doubles skip whole numbers
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const double value = (*column)[i];
    if (!(value >= 0) || value != std::floor(value) || value > largest_exact)
      throw InputError(name + ", particle " + std::to_string(i + 1) + ": its id is no whole number from 0 to 2^53");
    ids[i] = static_cast<std::uint64_t>(value);
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

/// @throws InputError where an id is there twice.
void sort_by_id(ParticleState& state, const std::string& name) {
  std::vector<std::size_t> order(state.ids.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return state.ids[a] < state.ids[b]; });
  state.ids = reordered(state.ids, order);
  const auto twice = std::adjacent_find(state.ids.begin(), state.ids.end());
  if (twice != state.ids.end())
    throw InputError(name + ": two particles have the id " + std::to_string(*twice) +
                     ": every particle needs its own, the same in every file of a sequence");
  state.positions = reordered(state.positions, order);
  state.velocities = reordered(state.velocities, order);
  state.rest_positions = reordered(state.rest_positions, order);
  state.densities = reordered(state.densities, order);
}

/// 0 where the column is missing or says nothing.
double median_radius(const Column* column) {
  if (column == nullptr || column->empty()) return 0;
  Column radii = *column;
  const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
  std::nth_element(radii.begin(), middle, radii.end());
  return std::isfinite(*middle) && *middle > 0 ? *middle : 0;
}

}  // namespace

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

ParticleFile particles_from_table(const ParticleTable& table, const std::string& name) {
  const Columns columns = columns_by_plain_name(table, name);
  const Triple place = find_vector(columns, position_names, "position", name);
  if (place[0] == nullptr) {
    std::vector<std::string> names;
    for (const auto& column : table.columns) names.push_back(column.first);
    throw InputError(
        fmt::format("{}: particles need the columns x, y and z; {}", name,
                    names.empty() ? "there are none" : fmt::format("there are: {}", fmt::join(names, ", "))));
  }
  const Triple velocity = find_vector(columns, velocity_names, "velocity", name);
  const Triple rest = find_vector(columns, rest_names, "rest position", name);
  const Column* ids = find_column(columns, id_names);
  const Column* densities = find_column(columns, density_names);

  ParticleFile file;
  file.has_ids = ids != nullptr;
  file.has_velocities = velocity[0] != nullptr;
  file.has_rest_positions = rest[0] != nullptr;
  file.radius = median_radius(find_column(columns, radius_names));
  if (file.radius == 0) file.radius = table.radius;
  ParticleState& state = file.state;
  state.ids = particle_ids(ids, table.count, name);
  state.positions = vectors(place, {}, "position", "m", name);
  state.velocities = vectors(velocity, std::vector<Vec3>(table.count, Vec3::Zero()), "velocity", "m/s", name);
  state.rest_positions = vectors(rest, state.positions, "rest position", "m", name);
  state.densities = densities != nullptr ? *densities : Column(table.count, 0.0);
  for (std::size_t i = 0; i < state.densities.size(); ++i) {
    if (!std::isfinite(state.densities[i]))
      throw InputError(name + ", particle " + std::to_string(i + 1) + ": the density is not finite");
    if (!(std::abs(state.densities[i]) <= largest_density))
      throw InputError(fmt::format("{}, particle {}: the density is {:.4g}; expected a number up to {:g}", name, i + 1,
                                   state.densities[i], largest_density));
  }
  if (file.has_ids) sort_by_id(state, name);
  return file;
}

ParticleState particles_from_ply(const std::filesystem::path& file) {
  return particles_from_ply(read_ply(file), file.string());
}

ParticleState particles_from_ply(const PlyFile& ply, const std::string& name) {
  return particles_from_table(table_from_ply(ply), name).state;
}

}  // namespace flowskin::scenes
