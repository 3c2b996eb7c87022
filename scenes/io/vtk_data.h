// The bytes of a data array of VTK's XML files: as they are or in base64, plain or compressed.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace flowskin::scenes {

/// The data is not as it should be.
struct VtkDataError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// How a file writes its binary arrays.
struct VtkEncoding {
  bool big_endian = false;
  bool wide_header = false;  ///< Headers of 8 bytes instead of 4.
  enum class Compressor { none, zlib, lz4 };
  Compressor compressor = Compressor::none;
};

/// The bytes of the array that starts at the beginning of `data`, where more may follow. A header in front tells how
/// many there are; with base64, header and data may be encoded apart or together.
/// @param expected number of bytes that the array must have
/// @throws VtkDataError where the data is too short, damaged, or of another size; never asks for much more memory than
/// `data` can stand for.
std::string vtk_array_bytes(std::string_view data, bool base64, const VtkEncoding& encoding, std::size_t expected);

}  // namespace flowskin::scenes
