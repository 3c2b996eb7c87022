// Text in UTF-16, as Windows programs export it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace flowskin::scenes {

/// Whether the text begins with the mark of UTF-16.
bool is_utf16(std::string_view bytes);
/// The same text in UTF-8, without the mark; what is no character becomes U+FFFD.
std::string utf8_of_utf16(std::string_view bytes);
/// Appends a character by its number; U+FFFD where it is none.
void append_utf8(std::uint32_t code, std::string& text);

}  // namespace flowskin::scenes
