// Files that are written whole or not at all.
#pragma once

#include <filesystem>
#include <string_view>

namespace flowskin::tools {

/// Writes `bytes` aside, checks that they reached the disk's file system, and renames to `file`.
/// @throws RunError naming the file and the reason (no space, no permission, no such directory); nothing is left
/// behind.
void write_file(const std::filesystem::path& file, std::string_view bytes);

}  // namespace flowskin::tools
