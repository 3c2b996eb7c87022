// Reads tables of numbers as text: CSV and its kin.
#pragma once

#include <string>
#include <string_view>

#include "scenes/io/particle_table.h"

namespace flowskin::scenes {

/// A line of column names, then a line of values per particle, parted by commas, semicolons, tabs or spaces (the names
/// tell which). Names and values may stand in double quotes; lines may end in LF, CR LF or CR; empty lines and lines
/// that start with # are left out, but names may stand behind a # as well, and other lines before them. Where commas do
/// not part the values, they may be decimal points. A column "time", or a line "Time: 0.5" before the names, gives the
/// time. Cells without a number, and rows that are too short, are faults of their columns (ParticleTable::faults).
/// @param name stands for the file in messages
/// @throws InputError naming the line and what was expected there.
ParticleTable parse_csv(std::string_view bytes, const std::string& name);

}  // namespace flowskin::scenes
