// The fluid particles, one array a quantity, kept in the order of a space-filling curve.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "common/parallel.h"
#include "sph/forces/pair_forces.h"
#include "sph/pairs/particle_pack.h"

namespace flowskin::sph {

struct ParticleArrays {
  std::vector<std::uint64_t> ids;
  std::vector<Vec3> positions;       ///< m
  std::vector<Vec3> velocities;      ///< m/s
  std::vector<Vec3> rest_positions;  ///< m
  std::vector<float> compressions;   ///< rho / rho_0 - 1
  std::vector<FluidPack> packs;
  std::vector<ParticleRates> rates;
  std::vector<float> wall_distances;    ///< m; see PairData
  std::vector<Eigen::Vector3f> shifts;  ///< XSPH or shifting; empty where both are off
  std::vector<std::uint8_t> fluids;     ///< Index of the fluid; empty where there is only one
  std::vector<float> viscosities;       ///< m^2/s; empty where all have the same at all times

  std::size_t size() const { return ids.size(); }

  /// Adds a particle without forces yet.
  void append(std::uint64_t id, const Vec3& position, const Vec3& velocity, const Vec3& rest_position,
              bool with_shift) {
    ids.push_back(id);
    positions.push_back(position);
    velocities.push_back(velocity);
    rest_positions.push_back(rest_position);
    compressions.push_back(0);
    packs.push_back({});
    rates.push_back({});
    wall_distances.push_back(0);
    if (with_shift) shifts.push_back(Eigen::Vector3f::Zero());
  }

  void reserve(std::size_t count, bool with_shifts, bool with_fluids, bool with_viscosities) {
    for_each([&](auto& values) { values.reserve(count); });
    if (!with_shifts) shifts = {};
    if (!with_fluids) fluids = {};
    if (!with_viscosities) viscosities = {};
  }

  /// Keeps the particles order[0], order[1], ... in this order and drops the others.
  void rearrange(const std::vector<std::uint32_t>& order) {
    for_each([&](auto& values) {
      if (!values.empty()) rearrange_one(values, order);
    });
  }

  /// Memory that belongs to nobody between two calls of rearrange().
  std::vector<char>& scratch() { return scratch_; }

  /// All arrays, for StateArchive.
  template <class Archive>
  void visit(Archive& archive) {
    for_each([&](auto& values) { archive(values); });
  }
  /// True where the arrays fit together, those that some set-ups need are there just where they are needed, and the
  /// particles are somewhere.
  bool is_consistent(bool with_shifts, bool with_fluids, bool with_viscosities) {
    bool same = true;
    for_each([&](auto& values) {
      const void* array = &values;
      const bool wanted = (array != &shifts || with_shifts) && (array != &fluids || with_fluids) &&
                          (array != &viscosities || with_viscosities);
      same = same && values.size() == (wanted ? size() : 0);
    });
    const auto finite = [](const auto& vectors) {
      return std::all_of(vectors.begin(), vectors.end(), [](const auto& v) { return v.allFinite(); });
    };
    const auto placed = [](const FluidPack& p) { return std::isfinite(p.x + p.y + p.z + p.vx + p.vy + p.vz); };
    return same && finite(positions) && finite(velocities) && finite(rest_positions) && finite(shifts) &&
           std::all_of(packs.begin(), packs.end(), placed);
  }

  std::size_t memory_bytes() {
    std::size_t bytes = scratch_.capacity();
    for_each([&](auto& values) { bytes += values.capacity() * sizeof(values[0]); });
    return bytes;
  }

 private:
  template <typename Function>
  void for_each(Function function) {
    function(ids);
    function(positions);
    function(velocities);
    function(rest_positions);
    function(compressions);
    function(packs);
    function(rates);
    function(wall_distances);
    function(shifts);
    function(fluids);
    function(viscosities);
  }

  // One raw buffer serves all arrays; their elements are plain numbers. Large ones go in two halves, so that the buffer
  // stays small.
  template <typename T>
  void rearrange_one(std::vector<T>& values, const std::vector<std::uint32_t>& order) {
    constexpr std::size_t part = sizeof(T) > 24 ? sizeof(T) / 2 : sizeof(T);
    static_assert(sizeof(T) % part == 0);
    scratch_.resize(std::max(scratch_.size(), order.size() * part));
    char* data = reinterpret_cast<char*>(values.data());
    char* buffer = scratch_.data();
    for (std::size_t offset = 0; offset < sizeof(T); offset += part) {
#pragma omp parallel for schedule(static) num_threads(threads_for(order.size()))
      for (std::size_t k = 0; k < order.size(); ++k) {
        std::memcpy(buffer + k * part, data + order[k] * sizeof(T) + offset, part);
      }
#pragma omp parallel for schedule(static) num_threads(threads_for(order.size()))
      for (std::size_t k = 0; k < order.size(); ++k) {
        std::memcpy(data + k * sizeof(T) + offset, buffer + k * part, part);
      }
    }
    values.resize(order.size());
  }

  std::vector<char> scratch_;
};

}  // namespace flowskin::sph
