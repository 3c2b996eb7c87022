// File names of a numbered sequence.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace flowskin::scenes {

/// The files that match a pattern whose last part may hold * (any letters), ? (one letter), %d or %04d (a number), in
/// the order of their numbers; where what the wildcards stand for is no number, in natural order (a2 before a10).
/// @throws SceneError where no file matches, the pattern names a folder, two files have the same number, or a number in
/// between is missing.
std::vector<std::filesystem::path> files_of_pattern(const std::string& pattern);

}  // namespace flowskin::scenes
