// What a particle file holds, whatever its format: columns of numbers by name.
#pragma once

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
  std::optional<double> time;  ///< s
  double radius = 0;           ///< Of all particles (m); 0 where the file does not say.
  std::size_t polygons = 0;    ///< Faces of a mesh: then these are no particles.
};

}  // namespace flowskin::scenes
