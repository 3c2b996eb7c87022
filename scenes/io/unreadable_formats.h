// Formats that are recognised, but not read.
#pragma once

#include <string_view>

namespace flowskin::scenes {

/// What the bytes are and how to convert them, for messages; empty where they are nothing known.
std::string_view unreadable_format(std::string_view bytes);

}  // namespace flowskin::scenes
