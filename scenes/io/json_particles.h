// Reads particles from JSON: arrays of places, of objects, or an object of arrays.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenes/io/particle_table.h"

namespace flowskin::scenes {

/// One table for each time step: [[x, y, z], ...]; [{"x": ..., "id": ...}, ...], where members may be vectors, too;
/// {"positions": [[x, y, z], ...], "velocities": ..., "time": ...}; {"x": [...], "y": [...], ...}; these under the key
/// "particles" or "points"; a list of such under "frames" or "steps".
/// @param name stands for the file in messages
/// @throws InputError naming the place and what was expected.
std::vector<ParticleTable> parse_json_particles(std::string_view bytes, const std::string& name);

/// Whether the text is JSON with particles in it, and no scene.
bool is_json_particles(std::string_view bytes);

/// A series of files as ParaView writes it beside VTK files (.vtk.series): time (s; numbered where it has none) and
/// name of each. @throws InputError where the text is none.
std::vector<std::pair<double, std::string>> parse_file_series(std::string_view bytes, const std::string& name);
/// Whether the text is a series of files.
bool is_file_series(std::string_view bytes);

}  // namespace flowskin::scenes
