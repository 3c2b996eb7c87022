// Particles from named columns, whoever wrote them.
#pragma once

#include <string>
#include <vector>

#include "scenes/io/particle_table.h"
#include "scenes/sources/particle_source.h"

namespace flowskin::scenes {

/// Particles and what the file told about them.
struct ParticleFile {
  ParticleState state;          ///< In order of ascending id; what is not there is made up for as the flags below say.
  bool has_ids = false;         ///< else: the order in the file
  bool has_velocities = false;  ///< else: zero
  bool has_rest_positions = false;  ///< else: the positions
  double radius = 0;                ///< Median of the particles' radii (m); 0: the file has none.
};

/// A column's name as it is compared: small letters, units in brackets left out, all other signs as one underscore:
/// "Points:0" and "points_0", "Vel.x [m/s]" and "vel_x" are the same.
std::string plain_column_name(const std::string& name);

/// docs/track.md lists the names that are understood.
/// @param name stands for the file in messages
/// @throws InputError where positions are missing, a value is not finite, or an id is no whole number or there twice.
ParticleFile particles_from_table(const ParticleTable& table, const std::string& name);

}  // namespace flowskin::scenes
