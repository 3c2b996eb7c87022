// The header of a PLY file: what its data are.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace flowskin::scenes {

enum class PlyFormat { ascii, little_endian, big_endian };
enum class PlyType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

/// Bytes of one value in a binary file.
std::size_t size_of(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;
  bool is_list = false;
  PlyType count_type = PlyType::uint8;  ///< Type of the length that stands before a list.
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  std::vector<std::string> comments;
  std::size_t data_start = 0;  ///< Offset of the first byte after the header.
};

/// Lines may end in LF or CR LF. `name` stands for the file in messages.
/// @throws InputError naming the line of the header and what was expected.
PlyHeader parse_ply_header(std::string_view bytes, const std::string& name);

}  // namespace flowskin::scenes
