// Text for terminals and logs.
#pragma once

#include <string>
#include <string_view>

namespace flowskin {

/// The text with its control characters as \x1b, but for ends of lines and tabs: names and contents of files must not
/// steer a terminal.
inline std::string printable(std::string_view text) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string result;
  const auto escape = [&](char c) {
    const auto byte = static_cast<unsigned char>(c);
    result += {'\\', 'x', digits[byte >> 4], digits[byte & 15]};
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    // U+0080 to U+009F, as UTF-8
    const bool is_wide_control = byte == 0xc2 && i + 1 < text.size() && (text[i + 1] & 0xe0) == 0x80;
    if (is_wide_control) {
      escape(text[i]);
      escape(text[++i]);
    } else if ((byte < 0x20 && byte != '\n' && byte != '\t') || byte == 0x7f) {
      escape(text[i]);
    } else {
      result += text[i];
    }
  }
  return result;
}

}  // namespace flowskin
