// File names of a numbered sequence.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace flowskin::scenes {

/// Files in the order of their numbers.
struct NumberedFiles {
  std::vector<std::filesystem::path> paths;
  /// How many intervals a file is after the first one: 0, 1, 2, ... where none is missing. The interval is the largest
  /// one that fits all numbers, so that files 0, 10, 20, 40 are at 0, 1, 2 and 4.
  std::vector<std::uint64_t> steps;
  std::vector<double> numbers;     ///< Of each file; empty where names have no one number.
  bool look_like_times = false;    ///< They have decimals or exponents.
  std::vector<std::string> notes;  ///< How the names were read, where there is doubt; one sentence each.
  std::string missing;             ///< In words, such as "3 files are missing (after f_2.ply)"; empty where none is.
  std::string uneven;              ///< In words: that the numbers only give the order; empty where they count steps.
};

/// The files of all names, each of which is a file, a folder (all particle files in it, or the one in each of its
/// numbered folders), or a pattern whose parts may hold * (any letters), ? (one letter), %d or %04d (a number). Their
/// order is that of order_of_names(), by the names of the files or, where those are the same, of their folders.
/// @throws InputError where there are no such files, two files have the same number, or their formats are mixed.
NumberedFiles files_of_patterns(const std::vector<std::string>& names);

}  // namespace flowskin::scenes
