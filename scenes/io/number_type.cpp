#include "scenes/io/number_type.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace flowskin::scenes {
namespace {

template <class T, class Number>
void append_as(std::string_view bytes, bool swap, std::vector<Number>& numbers) {
  for (std::size_t at = 0; at + sizeof(T) <= bytes.size(); at += sizeof(T)) {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes.data() + at, sizeof(T));
    if (swap) std::reverse(raw.begin(), raw.end());
    numbers.push_back(static_cast<Number>(std::bit_cast<T>(raw)));
  }
}

/// IEEE 754 half precision: a sign, 5 bits of exponent, 10 of fraction.
double number_of_half(std::uint16_t bits) {
  const int exponent = bits >> 10 & 31, fraction = bits & 1023;
  const double size = exponent == 31  ? (fraction == 0 ? HUGE_VAL : std::nan(""))
                      : exponent == 0 ? std::ldexp(fraction, -24)
                                      : std::ldexp(1024 + fraction, exponent - 25);
  return bits & 0x8000 ? -size : size;
}

void append_halves(std::string_view bytes, bool swap, std::vector<double>& numbers) {
  std::vector<std::uint16_t> halves;
  append_as<std::uint16_t>(bytes, swap, halves);
  for (const std::uint16_t half : halves) numbers.push_back(number_of_half(half));
}

}  // namespace

std::size_t size_of(NumberType type) {
  switch (type) {
    case NumberType::int8:
    case NumberType::uint8:
      return 1;
    case NumberType::int16:
    case NumberType::uint16:
    case NumberType::float16:
      return 2;
    case NumberType::int32:
    case NumberType::uint32:
    case NumberType::float32:
      return 4;
    default:
      return 8;
  }
}

void append_numbers(std::string_view bytes, NumberType type, bool big_endian, std::vector<double>& numbers) {
  const bool swap = big_endian != (std::endian::native == std::endian::big);
  numbers.reserve(numbers.size() + bytes.size() / size_of(type));
  switch (type) {
    case NumberType::int8:
      return append_as<std::int8_t>(bytes, swap, numbers);
    case NumberType::uint8:
      return append_as<std::uint8_t>(bytes, swap, numbers);
    case NumberType::int16:
      return append_as<std::int16_t>(bytes, swap, numbers);
    case NumberType::uint16:
      return append_as<std::uint16_t>(bytes, swap, numbers);
    case NumberType::int32:
      return append_as<std::int32_t>(bytes, swap, numbers);
    case NumberType::uint32:
      return append_as<std::uint32_t>(bytes, swap, numbers);
    case NumberType::int64:
      return append_as<std::int64_t>(bytes, swap, numbers);
    case NumberType::uint64:
      return append_as<std::uint64_t>(bytes, swap, numbers);
    case NumberType::float16:
      return append_halves(bytes, swap, numbers);
    case NumberType::float32:
      return append_as<float>(bytes, swap, numbers);
    case NumberType::float64:
      return append_as<double>(bytes, swap, numbers);
  }
}

std::vector<std::uint64_t> whole_numbers(std::string_view bytes, NumberType type, bool big_endian) {
  const bool swap = big_endian != (std::endian::native == std::endian::big);
  std::vector<std::uint64_t> numbers;
  switch (type) {
    case NumberType::int8:
      append_as<std::int8_t>(bytes, swap, numbers);
      break;
    case NumberType::uint8:
      append_as<std::uint8_t>(bytes, swap, numbers);
      break;
    case NumberType::int16:
      append_as<std::int16_t>(bytes, swap, numbers);
      break;
    case NumberType::uint16:
      append_as<std::uint16_t>(bytes, swap, numbers);
      break;
    case NumberType::int32:
      append_as<std::int32_t>(bytes, swap, numbers);
      break;
    case NumberType::uint32:
      append_as<std::uint32_t>(bytes, swap, numbers);
      break;
    case NumberType::int64:
      append_as<std::int64_t>(bytes, swap, numbers);
      break;
    case NumberType::uint64:
      append_as<std::uint64_t>(bytes, swap, numbers);
      break;
    default:
      break;
  }
  return numbers;
}

}  // namespace flowskin::scenes
