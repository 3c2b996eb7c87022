// Particles from named columns, whoever wrote them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scenes/io/particle_table.h"
#include "scenes/sources/particle_source.h"

namespace flowskin::scenes {

/// Particles that were left out as ParticleNeeds asks.
struct LeftOut {
  std::uint64_t by_keep = 0, by_region = 0, invalid = 0, duplicate = 0;
  std::uint64_t stray = 0;  ///< So far out that no grid reaches them.
  std::uint64_t unwanted() const { return by_keep + by_region + stray; }
  std::uint64_t all() const { return unwanted() + invalid + duplicate; }
  LeftOut& operator+=(const LeftOut& other);
};

/// Which options left out how many, as "370 by --keep, 5 by --skip-invalid"; empty where none did.
std::string left_out_text(const LeftOut& left_out);

/// Particles and what the file told about them.
struct ParticleFile {
  ParticleState state;          ///< In order of ascending id; what is not there is made up for as the flags below say.
  bool has_ids = false;         ///< else: the order in the file
  bool has_velocities = false;  ///< else: zero
  bool has_rest_positions = false;  ///< else: the positions
  double radius = 0;                ///< Median of the particles' radii (m); 0: the file has none.
  LeftOut left_out;
};

/// A column's name as it is compared: small letters, units in brackets left out, all other signs as one underscore:
/// "Points:0" and "points_0", "Vel.x [m/s]" and "vel_x" are the same.
std::string plain_column_name(const std::string& name);

/// Whether a column of this name holds ids.
bool is_id_name(const std::string& name);
/// Whether a column, or an array of vectors, of this name holds velocities or a component of them.
bool is_velocity_name(const std::string& name);
/// Whether a column of this name holds places, velocities, radii or densities, or a component of them.
bool is_property_name(const std::string& name);
/// Whether columns of these names hold positions, in two dimensions at least.
bool names_positions(const std::vector<std::string>& names);

/// What is asked of a file.
struct ParticleNeeds {
  bool ids = true;     ///< false: ids are not looked at
  std::string keep{};  ///< An expression of columns (row_filter.h) that wanted particles fulfil; empty: all.
  std::optional<sph::Box> region{};  ///< Only particles in it (m).
  bool skip_invalid = false;     ///< Leave out particles with values that are no finite numbers, instead of an error.
  bool skip_duplicates = false;  ///< Leave out particles whose id or place an earlier one has.
};

/// docs/track.md lists the names that are understood.
/// @param name stands for the file in messages
/// @throws InputError where positions are missing, a value that is needed is missing or not finite, or an id is no
/// whole number or there twice. Columns that nobody needs may hold anything.
ParticleFile particles_from_table(const ParticleTable& table, const std::string& name, const ParticleNeeds& needs = {});

}  // namespace flowskin::scenes
