// Bytes and text of a file in the making.
#pragma once

#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

namespace flowskin::scenes {

/// Numbers in a value, and the bytes that each takes in a file.
template <class T>
inline constexpr int components_of = 1;
template <class T>
requires requires(T v) { v[0]; }
inline constexpr int components_of<T> = static_cast<int>(sizeof(T) / sizeof(T{}[0]));
template <class T>
inline constexpr std::size_t bytes_of_number = std::is_same_v<T, std::uint64_t>                          ? 8
                                               : sizeof(T) == static_cast<std::size_t>(components_of<T>) ? 1
                                                                                                         : 4;

/// Grows by binary little-endian values and by numbers as text, and is then written in one go.
class ByteBuffer {
 public:
  void reserve(std::size_t bytes) { bytes_.reserve(bytes); }
  std::string_view view() const { return bytes_; }
  std::size_t size() const { return bytes_.size(); }

  void text(std::string_view text) { bytes_.append(text); }
  void character(char c) { bytes_.push_back(c); }

  /// The shortest text that gives the number back when read, in any locale.
  template <class Number>
  void number(Number value) {
    std::array<char, 32> digits;
    const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    bytes_.append(digits.data(), result.ptr);
  }

  void byte(std::uint8_t value) { bytes_.push_back(static_cast<char>(value)); }
  void u32(std::uint32_t value) { little_endian(value); }
  void u64(std::uint64_t value) { little_endian(value); }
  void i32(std::int32_t value) { little_endian(static_cast<std::uint32_t>(value)); }
  void f32(float value) { little_endian(std::bit_cast<std::uint32_t>(value)); }
  void f64(double value) { little_endian(std::bit_cast<std::uint64_t>(value)); }
  /// x, y and z as float32.
  template <class Vector>
  void vec3(const Vector& v) {
    for (int k = 0; k < 3; ++k) f32(static_cast<float>(v[k]));
  }

  /// A value by its type: numbers of floating point as float32, each component of a vector or colour.
  template <class T>
  void value(const T& v) {
    if constexpr (std::is_same_v<T, std::uint64_t>)
      u64(v);
    else if constexpr (std::is_same_v<T, std::uint8_t>)
      byte(v);
    else if constexpr (std::is_floating_point_v<T>)
      f32(static_cast<float>(v));
    else
      for (int k = 0; k < components_of<T>; ++k) value(v[k]);
  }

 private:
  template <class Unsigned>
  void little_endian(Unsigned value) {
    std::array<char, sizeof(Unsigned)> bytes;
    for (std::size_t k = 0; k < bytes.size(); ++k) bytes[k] = static_cast<char>((value >> (8 * k)) & 0xff);
    bytes_.append(bytes.data(), bytes.size());
  }

  std::string bytes_;
};

}  // namespace flowskin::scenes
