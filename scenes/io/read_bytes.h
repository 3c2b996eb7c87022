// A whole file in memory: the one place where inputs are opened.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>

namespace flowskin::scenes {

/// @throws InputError where the input is missing or anything but a regular file (links are followed): pipes and devices
/// may never end.
void require_regular_file(const std::filesystem::path& file);

/// The bytes of `file`. @throws InputError where it is no regular file, cannot be read, or has more bytes than `most`
/// or than the machine has memory.
std::string read_bytes(const std::filesystem::path& file,
                       std::uintmax_t most = std::numeric_limits<std::uintmax_t>::max());

/// The first bytes of `file`, at most `count`. @throws InputError as read_bytes().
std::string first_bytes(const std::filesystem::path& file, std::size_t count);

}  // namespace flowskin::scenes
