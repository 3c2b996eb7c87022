// Compressed bytes: gzip, and the deflate that zip files use.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace flowskin::scenes {

/// Whether the bytes begin as a gzip file does.
bool is_gzip(std::string_view bytes);

/// What a gzip file holds, all of its members after one another.
/// @param name stands for the file in messages
/// @throws InputError where it is damaged or truncated, or holds so much more than its size that it cannot be meant.
std::string gunzipped(std::string_view bytes, const std::string& name);

/// `size` bytes from deflate's raw form, as zip files hold them.
/// @throws InputError where they are damaged, or are not of that size.
std::string inflated(std::string_view bytes, std::uint64_t size, const std::string& name);

}  // namespace flowskin::scenes
