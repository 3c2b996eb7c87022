// Reads the points of VTK's legacy files (.vtk).
#pragma once

#include <string>
#include <string_view>

#include "scenes/io/particle_table.h"

namespace flowskin::scenes {

/// Points and their attributes (SCALARS, VECTORS, NORMALS, FIELD ...) of a dataset POLYDATA, UNSTRUCTURED_GRID or
/// STRUCTURED_GRID, ASCII or BINARY (big endian); attributes of cells are passed over. Vectors become columns name_0,
/// name_1, name_2. The field arrays TIME or TimeValue give the time.
/// @param name stands for the file in messages
/// @throws InputError naming the line (or, in binary data, the byte) and what was expected there.
ParticleTable parse_vtk(std::string_view bytes, const std::string& name);

}  // namespace flowskin::scenes
