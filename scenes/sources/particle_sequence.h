// What is known about a recorded sequence before it is played: its files, their times, and who is who.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "scenes/io/particle_columns.h"
#include "scenes/scene.h"
#include "scenes/sources/frame_tables.h"

namespace flowskin::scenes {

struct ParticleSequence {
  enum class Ids { of_files, order, none };

  std::vector<FrameTables::Place> places;  ///< Where the particles of each frame are.
  std::vector<double> times;               ///< s, ascending, the first is 0
  double interval = 0;                     ///< Usual time between frames (s).
  bool is_even = true;                     ///< All times are whole multiples of the interval.
  Ids ids = Ids::of_files;
  ParticleFile first;              ///< The first file.
  ParticleNeeds needs;             ///< What is asked of all.
  std::vector<std::string> notes;  ///< What was taken for granted, one sentence each.
  std::vector<std::string> warnings;
  std::shared_ptr<FrameTables> tables = std::make_shared<FrameTables>();  ///< A file of many steps is read once.
};

/// Looks at the files of `spec`. All of them are read once where their times or numbers of particles are needed.
/// @param directory where relative names start
/// @throws InputError naming the file and what is wrong with it or with the sequence.
ParticleSequence open_sequence(const RecordedSpec& spec, const std::string& directory);

/// The files that `spec` names, a .pvd or .vtk.series included; none is looked into but that.
/// @throws InputError where there are none.
std::vector<std::filesystem::path> sequence_files(const RecordedSpec& spec, const std::string& directory);

/// The same, frame by frame: files of one time are parts of one frame.
std::vector<FrameTables::Place> sequence_places(const RecordedSpec& spec, const std::string& directory);

/// Whether a file names others and their times: a .pvd or .vtk.series, whatever it is called.
bool is_collection(const std::filesystem::path& file);

/// Frame k. @throws InputError also where it lacks ids or velocities that the first file has.
ParticleFile read_sequence_file(const ParticleSequence& sequence, std::size_t k);

}  // namespace flowskin::scenes
