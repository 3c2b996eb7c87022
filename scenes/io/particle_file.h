// Particle files of all formats.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "scenes/io/particle_columns.h"
#include "scenes/io/particle_table.h"

namespace flowskin::scenes {

/// Ends of names of the formats that are read: ".csv", ".ply", ...
bool is_particle_extension(std::string extension);
/// Those, for messages.
std::string particle_extensions();

/// PLY, legacy VTK or VTK XML by what the file starts with; everything else that is text counts as CSV.
/// @param name stands for the file in messages
/// @throws InputError naming the file, the place in it, and what was expected.
ParticleTable parse_particle_table(std::string_view bytes, const std::string& name);
ParticleTable read_particle_table(const std::filesystem::path& file);

/// The particles of a file. @throws InputError, also where the file holds a mesh.
ParticleFile read_particles(const std::filesystem::path& file, const ParticleNeeds& needs = {});

}  // namespace flowskin::scenes
