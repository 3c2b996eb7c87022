// The header of NumPy's .npy files: a Python dictionary that says how numbers lie.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/errors.h"
#include "scenes/io/number_type.h"

namespace flowskin::scenes {

/// The array holds no numbers but words or Python objects.
struct NpyNotNumbers : InputError {
  using InputError::InputError;
};

/// One number of a record, or an array of them.
struct NpyField {
  std::string name;  ///< Empty where the array has no named fields.
  NumberType type = NumberType::float64;
  bool big_endian = false;
  std::vector<std::uint64_t> shape;
  std::uint64_t start = 0;  ///< In bytes from the start of a record.
  std::uint64_t size = 0;   ///< In bytes, of all numbers.
};

struct NpyHeader {
  std::vector<NpyField> fields;   ///< Of numbers: fields of words are left out.
  std::uint64_t record_size = 0;  ///< bytes
  std::vector<std::uint64_t> shape;
  bool first_index_fastest = false;  ///< As in Fortran.
};

/// @param name stands for the file in messages
/// @throws NpyNotNumbers, and InputError where the header is none
NpyHeader parse_npy_header(std::string_view text, const std::string& name);

/// The same entries of an array of this shape with the last index running fastest instead of the first.
template <class Number>
std::vector<Number> last_index_fastest(const std::vector<Number>& values, const std::vector<std::uint64_t>& shape) {
  std::vector<Number> result(values.size());
  std::vector<std::uint64_t> index(shape.size(), 0);
  for (const Number& value : values) {
    std::uint64_t place = 0;
    for (std::size_t k = 0; k < shape.size(); ++k) place = place * shape[k] + index[k];
    result[place] = value;
    for (std::size_t k = 0; k < shape.size() && ++index[k] == shape[k]; ++k) index[k] = 0;
  }
  return result;
}

}  // namespace flowskin::scenes
