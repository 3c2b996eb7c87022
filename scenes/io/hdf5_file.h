// A thin, safe skin on HDF5's C library: groups, arrays of numbers and times of a file in memory.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/io/named_arrays.h"

namespace flowskin::scenes {

class Hdf5File {
 public:
  /// @throws InputError where the library cannot open it
  Hdf5File(std::string_view bytes, const std::string& name);
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;
  ~Hdf5File();

  /// A group and the names of the arrays of numbers in it, with their shapes; values are not read yet.
  struct Group {
    std::string path;  ///< "/" for the root
    std::vector<NamedArray> arrays;
    std::optional<double> time;  ///< s, where an attribute tells it
  };
  /// All groups, those within others after them. Links to other places are not followed.
  std::vector<Group> groups() const;
  /// Reads the values of an array of a group. @throws InputError where they cannot be read
  void read(const Group& group, NamedArray& array) const;

 private:
  void add_group(const std::string& path, int level, std::vector<Group>& groups) const;
  /// Where the array is too large for the file, or holds no numbers: empty.
  std::optional<NamedArray> described(const std::string& path, const std::string& array) const;

  std::string image_;  // as long as the file is open
  const std::string& name_;
  std::int64_t file_ = -1;
};

}  // namespace flowskin::scenes
