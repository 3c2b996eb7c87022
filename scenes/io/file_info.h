// What is in a mesh or particle file, in words.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace flowskin::scenes {

struct FileInfo {
  std::vector<std::string> lines;  ///< A description for people, one fact a line.
  bool sound = true;               ///< A closed, two-manifold, outward surface, or particles without fault.
};

/// Describes a surface (OBJ, PLY, VTP) or particles of any format, by the content of the file. What is wrong with a
/// mesh that can be read stands in the lines and makes it unsound.
/// @throws InputError where the file cannot be read at all, or is of another kind.
FileInfo describe_file(const std::filesystem::path& file);

/// Describes the sequence that a folder, a .pvd or a .vtk.series names: how many files, and what the first is. Files
/// that are not there make it unsound. @throws InputError
FileInfo describe_sequence(const std::filesystem::path& place);

}  // namespace flowskin::scenes
