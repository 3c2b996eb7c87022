#include "scenes/io/number_type.h"

#include <algorithm>
#include <array>
#include <bit>
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

}  // namespace

std::size_t size_of(NumberType type) {
  switch (type) {
    case NumberType::int8:
    case NumberType::uint8:
      return 1;
    case NumberType::int16:
    case NumberType::uint16:
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
