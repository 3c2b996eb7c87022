// A whole file in memory.
#pragma once

#include <filesystem>
#include <string>

namespace flowskin::scenes {

/// The bytes of `file`. @throws InputError where it is missing, a directory, or cannot be read.
std::string read_bytes(const std::filesystem::path& file);

}  // namespace flowskin::scenes
