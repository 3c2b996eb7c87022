// CRC-32, to tell whether files are what they were.
#pragma once

#include <cstdint>
#include <string_view>

namespace flowskin::scenes {

/// CRC-32 of bytes, going on from that of the bytes before them; 0 at the start.
std::uint32_t checksum(std::uint32_t before, std::string_view bytes);

}  // namespace flowskin::scenes
