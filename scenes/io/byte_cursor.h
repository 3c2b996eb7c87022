// Walks over the bytes of a binary file.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "common/errors.h"

namespace flowskin::scenes {

/// Hands out numbers and pieces in order. `name` stands for the file in messages and must outlive the cursor.
class ByteCursor {
 public:
  ByteCursor(std::string_view bytes, bool big_endian, const std::string& name)
      : bytes_(bytes), swap_(big_endian != (std::endian::native == std::endian::big)), name_(name) {}

  std::size_t place() const { return at_; }
  std::size_t left() const { return bytes_.size() - at_; }

  /// @throws InputError where the file ends before
  std::string_view take(std::uint64_t count, const char* what) {
    if (count > left())
      throw InputError(fmt::format("{}, byte {}: {} should be here, but the file ends: it is truncated or damaged",
                                   name_, at_, what));
    const std::string_view taken = bytes_.substr(at_, static_cast<std::size_t>(count));
    at_ += taken.size();
    return taken;
  }

  template <class Number>
  Number number(const char* what) {
    const std::string_view taken = take(sizeof(Number), what);
    std::array<char, sizeof(Number)> raw;
    std::memcpy(raw.data(), taken.data(), raw.size());
    if (swap_) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<Number>(raw);
  }

  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(fmt::format("{}, byte {}: {}", name_, at_, message));
  }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
  bool swap_;
  const std::string& name_;
};

}  // namespace flowskin::scenes
