// Particles from the columns of a PLY file, whoever wrote it.
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numeric>

#include "scenes/io/ply_reader.h"
#include "scenes/scene_file.h"

namespace flowskin::scenes {
namespace {

using Column = std::vector<double>;

/// The column of the first of these names that is there, or nullptr.
const Column* find_column(const PlyFile& ply, std::initializer_list<const char*> names) {
  for (const char* name : names)
    if (const auto found = ply.vertex.find(name); found != ply.vertex.end()) return &found->second;
  return nullptr;
}

/// Three columns as vectors; `fallback` where they are not there.
/// @throws SceneError where only some of the three are there, or a value is not finite.
std::vector<Vec3> vectors(const std::array<const Column*, 3>& columns, const std::vector<Vec3>& fallback,
                          const std::string& what, const std::string& name) {
  const auto present = std::count_if(columns.begin(), columns.end(), [](const Column* c) { return c != nullptr; });
  if (present == 0) return fallback;
  if (present < 3) throw SceneError(name + ": only some components of the " + what + " are there, three were expected");
  std::vector<Vec3> result(columns[0]->size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] = Vec3((*columns[0])[i], (*columns[1])[i], (*columns[2])[i]);
    if (!result[i].allFinite())
      throw SceneError(name + ", particle " + std::to_string(i + 1) + ": the " + what + " is not finite");
  }
  return result;
}

std::vector<std::uint64_t> particle_ids(const PlyFile& ply, const std::string& name) {
  std::vector<std::uint64_t> ids(ply.vertex_count);
  const Column* column = find_column(ply, {"id", "ids", "particle_id"});
  if (column == nullptr) {
    std::iota(ids.begin(), ids.end(), std::uint64_t{0});
    return ids;
  }
  constexpr double largest_exact = 9007199254740992.0;  // 2^53: beyond it doubles skip whole numbers
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const double value = (*column)[i];
    if (!(value >= 0) || value != std::floor(value) || value > largest_exact)
      throw SceneError(name + ", particle " + std::to_string(i + 1) + ": its id is no whole number from 0 to 2^53");
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

/// @throws SceneError where an id is there twice.
void sort_by_id(ParticleState& state, const std::string& name) {
  std::vector<std::size_t> order(state.ids.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return state.ids[a] < state.ids[b]; });
  state.ids = reordered(state.ids, order);
  const auto twice = std::adjacent_find(state.ids.begin(), state.ids.end());
  if (twice != state.ids.end())
    throw SceneError(name + ": two particles have the id " + std::to_string(*twice) +
                     ": every particle needs its own, the same in every file of a sequence");
  state.positions = reordered(state.positions, order);
  state.velocities = reordered(state.velocities, order);
  state.rest_positions = reordered(state.rest_positions, order);
  state.densities = reordered(state.densities, order);
}

}  // namespace

ParticleState particles_from_ply(const std::filesystem::path& file) {
  return particles_from_ply(read_ply(file), file.string());
}

ParticleState particles_from_ply(const PlyFile& ply, const std::string& name) {
  const auto find = [&ply](std::initializer_list<const char*> names) { return find_column(ply, names); };
  const std::array<const Column*, 3> place{find({"x"}), find({"y"}), find({"z"})};
  if (std::find(place.begin(), place.end(), nullptr) != place.end())
    throw SceneError(name + ": particles need the vertex properties x, y and z");

  ParticleState state;
  state.ids = particle_ids(ply, name);
  state.positions = vectors(place, {}, "position", name);
  state.velocities =
      vectors({find({"vx", "velocity_x", "velocity_0", "v_x"}), find({"vy", "velocity_y", "velocity_1", "v_y"}),
               find({"vz", "velocity_z", "velocity_2", "v_z"})},
              std::vector<Vec3>(ply.vertex_count, Vec3::Zero()), "velocity", name);
  state.rest_positions = vectors(
      {find({"rest_x", "rest_position_x"}), find({"rest_y", "rest_position_y"}), find({"rest_z", "rest_position_z"})},
      state.positions, "rest position", name);
  const Column* densities = find({"density", "densities", "rho"});
  state.densities = densities != nullptr ? *densities : Column(ply.vertex_count, 0.0);
  for (std::size_t i = 0; i < state.densities.size(); ++i)
    if (!std::isfinite(state.densities[i]))
      throw SceneError(name + ", particle " + std::to_string(i + 1) + ": the density is not finite");
  sort_by_id(state, name);
  return state;
}

}  // namespace flowskin::scenes
