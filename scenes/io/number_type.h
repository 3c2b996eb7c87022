// Types of numbers in binary files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace flowskin::scenes {

enum class NumberType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float16, float32, float64 };

std::size_t size_of(NumberType type);

/// Appends the numbers that `bytes` holds, all of which are used; a surplus of less than a number is left out.
void append_numbers(std::string_view bytes, NumberType type, bool big_endian, std::vector<double>& numbers);

/// The same of whole numbers of any width, as the bits of 64-bit numbers; nothing where the type is none of them.
std::vector<std::uint64_t> whole_numbers(std::string_view bytes, NumberType type, bool big_endian);

}  // namespace flowskin::scenes
