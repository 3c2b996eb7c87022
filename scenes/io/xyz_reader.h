// Reads XYZ files: a number of particles, a comment, and a line a particle, again and again.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenes/io/particle_table.h"

namespace flowskin::scenes {

/// Whether the text is XYZ: with a number of particles in front, or just lines of x y z, after a word or not.
bool is_xyz(std::string_view bytes);

/// One table for each time step. A line holds x y z, or an element and x y z; further numbers are read only where the
/// comment tells what they are: Properties=species:S:1:pos:R:3:velo:R:3 (extended XYZ), or names of columns. The
/// comment may tell the time as well: Time=0.5, Timestep: 100.
/// @param name stands for the file in messages
/// @throws InputError naming the line and what was expected there.
std::vector<ParticleTable> parse_xyz(std::string_view bytes, const std::string& name);

}  // namespace flowskin::scenes
