// Reads tables of numbers as text: CSV and its kin.
#pragma once

#include <string>
#include <string_view>

#include "scenes/io/particle_table.h"

namespace flowskin::scenes {

/// A line of column names, then a line of values per particle, parted by commas, semicolons, tabs or spaces (the names
/// tell which). Names and values may stand in double quotes; lines may end in LF or CR LF; empty lines and lines that
/// start with # are left out, but names may stand behind a # as well. A column "time" gives the time of the file.
/// @param name stands for the file in messages
/// @throws InputError naming the line and what was expected there.
ParticleTable parse_csv(std::string_view bytes, const std::string& name);

}  // namespace flowskin::scenes
