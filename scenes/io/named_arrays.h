// Arrays of numbers by name, as NumPy and HDF5 files hold them, and how they become particles.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenes/io/particle_table.h"

namespace flowskin::scenes {

struct NamedArray {
  std::string name;
  std::vector<std::uint64_t> shape;    ///< Empty: a single number.
  std::vector<double> values;          ///< The last index runs fastest.
  std::vector<std::uint64_t> whole{};  ///< The same exactly, as bits, where they are whole numbers.
};

/// The number of entries of a shape; 0 where there are none, and where they are too many to be counted.
std::uint64_t entries_of(const std::vector<std::uint64_t>& shape);

/// Whether there are places among the arrays, whose values are not looked at.
bool have_places(const std::vector<NamedArray>& arrays);

/// One table for each time step. The array of places decides how many particles and steps there are: of N x 3 or
/// steps x N x 3 where its name is one of positions (x of N x 3, too), else three arrays such as x, y, z of N or
/// steps x N. Arrays with as many entries become columns, of steps as well; others are left out. An array t or time
/// tells the time. @param name stands for the file in messages
/// @throws InputError where there are no places among them.
std::vector<ParticleTable> tables_from_arrays(const std::vector<NamedArray>& arrays, const std::string& name);

}  // namespace flowskin::scenes
