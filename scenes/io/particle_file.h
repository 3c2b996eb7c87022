// Particle files of all formats.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/io/particle_columns.h"
#include "scenes/io/particle_table.h"

namespace flowskin::scenes {

/// Ends of names of the formats that are read: ".csv", ".ply", ..., also with ".gz" behind.
bool is_particle_extension(std::string extension);
/// Those, for messages.
std::string particle_extensions();

/// One table for each time step that the file holds, in their order; at least one. What the file starts with tells the
/// format; everything else that is text counts as CSV. Files within gzip are read as well.
/// @param name stands for the file in messages
/// @throws InputError naming the file, the place in it, and what was expected.
std::vector<ParticleTable> parse_particle_steps(std::string_view bytes, const std::string& name);
/// The first of these.
ParticleTable parse_particle_table(std::string_view bytes, const std::string& name);

/// The same of a file; the pieces that a .pvtp or .pvtu names are read as one.
std::vector<ParticleTable> read_particle_steps(const std::filesystem::path& file);
ParticleTable read_particle_table(const std::filesystem::path& file);

/// The particles of a table. @throws InputError, also where it holds a mesh.
ParticleFile particles_of_file(const ParticleTable& table, const std::string& name, const ParticleNeeds& needs = {});
/// The particles of a file: of its first time step.
ParticleFile read_particles(const std::filesystem::path& file, const ParticleNeeds& needs = {});

}  // namespace flowskin::scenes
