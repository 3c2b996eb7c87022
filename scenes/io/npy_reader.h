// Reads NumPy's files: one array (.npy), or several by name (.npz).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenes/io/particle_table.h"

namespace flowskin::scenes {

/// Whether the bytes begin as a .npy file does.
bool is_npy(std::string_view bytes);
/// Whether the bytes are a zip archive, as .npz files are.
bool is_zip(std::string_view bytes);

/// One table for each time step: an array of N x 3 places, of steps x N x 3, or of N records with named fields.
/// @param name stands for the file in messages
/// @throws InputError naming the array and what was expected.
std::vector<ParticleTable> parse_npy(std::string_view bytes, const std::string& name);

/// The same of an archive of arrays, whose names tell what they are: places as x, y and z or as pos, positions, X (N x
/// 3 or steps x N x 3); velocities, ids and whatever else has as many entries become columns; t or time the time.
std::vector<ParticleTable> parse_npz(std::string_view bytes, const std::string& name);

}  // namespace flowskin::scenes
