// Text in UTF-16, as Windows programs export it.
#pragma once

#include <string>
#include <string_view>

namespace flowskin::scenes {

/// Whether the text begins with the mark of UTF-16.
bool is_utf16(std::string_view bytes);
/// The same text in UTF-8, without the mark; what is no character becomes U+FFFD.
std::string utf8_of_utf16(std::string_view bytes);

}  // namespace flowskin::scenes
