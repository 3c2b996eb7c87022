// Reads the points of Houdini's classic geometry files (.bgeo of Houdini 11 and before, of Partio and SPlisHSPlasH).
#pragma once

#include <string>
#include <string_view>

#include "scenes/io/particle_table.h"

namespace flowskin::scenes {

/// Whether the bytes begin as a classic BGEO file does.
bool is_bgeo(std::string_view bytes);

/// Points and their attributes; primitives are left out. Vectors become columns name_0, name_1, name_2.
/// @param name stands for the file in messages
/// @throws InputError naming the byte and what was expected.
ParticleTable parse_bgeo(std::string_view bytes, const std::string& name);

}  // namespace flowskin::scenes
