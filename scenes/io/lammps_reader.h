// Reads LAMMPS's text dumps, of one or many time steps.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenes/io/particle_table.h"

namespace flowskin::scenes {

/// Whether the text begins as a dump does.
bool is_lammps_dump(std::string_view bytes);

/// One table for each time step. Positions are x y z or, where these are missing, xu yu zu, or xs ys zs (and xsu ysu
/// zsu) by the box, which may be triclinic; they become x, y and z. Other columns keep their names; words are faults.
/// @param name stands for the file in messages
/// @throws InputError naming the line and what was expected there.
std::vector<ParticleTable> parse_lammps_dump(std::string_view bytes, const std::string& name);

}  // namespace flowskin::scenes
