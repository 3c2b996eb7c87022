// What every writer makes sure of before it writes.
#pragma once

#include <filesystem>

#include "scenes/io/frames.h"

namespace flowskin::scenes {

/// @throws RunError naming `file` and the first vertex or triangle that is wrong: arrays of unequal length, a number
/// that is not finite (also as float), or an index out of range. A file with such data is worse than none.
void check_frame(const SurfaceFrame& frame, const std::filesystem::path& file);
void check_frame(const ParticleFrame& frame, const std::filesystem::path& file);

}  // namespace flowskin::scenes
