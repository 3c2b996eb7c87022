// What a particle file holds, whatever its format: columns of numbers by name.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace flowskin::scenes {

struct ParticleTable {
  std::string format;     ///< For messages, such as "CSV" or "VTP (appended, base64, zlib)".
  std::size_t count = 0;  ///< particles
  /// By the name in the file, each with `count` entries. Components of a vector are name_0, name_1, ...; positions of
  /// formats that do not name them are x, y, z.
  std::map<std::string, std::vector<double>> columns;
  /// Exact values of columns that are called ids (is_id_name), as the bits of 64-bit numbers; where all are whole.
  std::map<std::string, std::vector<std::uint64_t>> ids;
  /// What is wrong with a column, and where; the values in question are NaN. It only stops who needs the column.
  std::map<std::string, std::string> faults;
  std::optional<double> time;                 ///< s
  std::optional<std::uint64_t> step;          ///< The number of the time step, where the file counts steps.
  double radius = 0;                          ///< Of all particles (m); 0 where the file does not say.
  std::size_t polygons = 0;                   ///< Faces of a mesh: then these are no particles.
  std::vector<std::string> notes;             ///< How it was read, where there is doubt; one sentence each.
  std::vector<std::array<int, 3>> triangles;  ///< These faces as triangles, where the format is VTK XML.
};

/// Where the faults of a column begin is what counts.
inline void note_fault(ParticleTable& table, const std::string& column, const std::string& what) {
  table.faults.emplace(column, what);
}

}  // namespace flowskin::scenes
