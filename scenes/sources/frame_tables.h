// Where the particles of each frame of a sequence are: a file, several parts read as one, or one of many time steps in
// a file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "scenes/io/particle_table.h"

namespace flowskin::scenes {

/// Reads the particles of places. A file of many steps is read once and kept until another one is asked for: it needs
/// as much memory as all of its steps.
class FrameTables {
 public:
  /// The particles of one frame.
  struct Place {
    std::filesystem::path file;               ///< The first part.
    std::vector<std::filesystem::path> more;  ///< Further parts, read as one with the first.
    std::size_t step = 0;                     ///< Which step of the file.
    bool is_only_step = true;                 ///< The file holds no other.

    /// For messages: the file, and which step of it.
    std::string name() const;
  };

  /// The steps that a file holds.
  const std::vector<ParticleTable>& steps(const std::filesystem::path& file);
  /// @throws InputError where the file cannot be read, or holds steps where it should hold one
  ParticleTable table(const Place& place);

 private:
  std::filesystem::path kept_file_;
  std::vector<ParticleTable> kept_;
};

/// Tells whether the particles of a place are what they were: of the bytes of its files, or of the step's numbers.
std::uint32_t checksum_of_place(const FrameTables::Place& place, FrameTables& tables);
/// A cheaper sign of it: the bytes of the files, or the number of particles of the step.
std::uint64_t size_of_place(const FrameTables::Place& place, FrameTables& tables);

}  // namespace flowskin::scenes
