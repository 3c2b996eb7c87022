// Formats that are recognised, but not read.
#pragma once

#include <string>
#include <string_view>

namespace flowskin::scenes {

/// What the bytes are and how to convert them, for messages; empty where they are nothing known.
std::string_view unreadable_format(std::string_view bytes);

/// The same of text, by what stands in its first lines.
std::string_view unreadable_text(std::string_view text);

/// What files with the ending of this name usually are, where they are nothing that can be read; else empty.
std::string_view unreadable_ending(const std::string& name);

}  // namespace flowskin::scenes
