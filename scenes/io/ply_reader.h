// Reads PLY files (ascii and binary, both byte orders) into named columns.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/io/particle_table.h"
#include "scenes/sources/particle_source.h"

namespace flowskin::scenes {

/// The vertex element as columns of numbers by property name, the faces as triangles (polygons are split as fans).
struct PlyFile {
  std::size_t vertex_count = 0;
  std::map<std::string, std::vector<double>> vertex;      ///< each with vertex_count entries
  std::map<std::string, std::vector<std::uint64_t>> ids;  ///< exact values of 64-bit ids, as their bits
  std::set<std::string> repeated;                         ///< properties named twice; the first counts
  std::vector<std::array<int, 3>> triangles;
  std::map<std::string, std::vector<double>> face_lists;  ///< other lists of the faces, each as one row of numbers
  std::vector<std::string> comments;
};

/// @throws InputError naming the file and what is wrong with it (not a PLY, truncated, bad index, ...).
PlyFile read_ply(const std::filesystem::path& file);
/// The same from bytes in memory; `name` stands for the file in messages.
PlyFile parse_ply(std::string_view bytes, const std::string& name);

/// The vertex element as particles; comments such as "time 0.5" and "radius 0.01" are understood (s, m).
ParticleTable table_from_ply(const PlyFile& ply);

/// Particles from columns x, y, z and, where present, vx, vy, vz (or velocity_x, ...), rest_x, rest_y, rest_z, id,
/// density.
ParticleState particles_from_ply(const std::filesystem::path& file);
/// The same from a file already read; `name` stands for it in messages.
ParticleState particles_from_ply(const PlyFile& ply, const std::string& name);

}  // namespace flowskin::scenes
