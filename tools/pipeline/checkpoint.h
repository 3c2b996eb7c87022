// Checkpoints: the whole state of a run, from which it can be gone on with (docs/restart.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/state_archive.h"

namespace flowskin::tools {

/// What was in a file that a key of the scene names.
struct FileContent {
  std::string key;             ///< Such as "emitters[0].file".
  std::string file;            ///< As the scene names it.
  std::uint32_t checksum = 0;  ///< Of what was read from it.

  bool operator==(const FileContent&) const = default;
  template <class Archive>
  void visit(Archive& archive) {
    archive(key, file, checksum);
  }
};

/// What a checkpoint says of the run that it belongs to.
struct CheckpointHeader {
  std::string program;  ///< As version_text().
  std::string scene;    ///< The scene as run (JSON).
  std::vector<FileContent> files;
  std::string compare;  ///< The methods compared; empty: none.
  int frame = -1;       ///< The last one that is written; the state may be on its way to the next.

  template <class Archive>
  void visit(Archive& archive) {
    archive(program, scene, files, compare, frame);
  }
};

/// A checkpoint that has been read, and found whole.
class Checkpoint {
 public:
  /// @throws InputError where the file is damaged, cut short, of another program or of another version of this one.
  explicit Checkpoint(std::filesystem::path file);
  Checkpoint(const Checkpoint&) = delete;
  Checkpoint& operator=(const Checkpoint&) = delete;

  const std::filesystem::path& file() const { return file_; }
  const CheckpointHeader& header() const { return header_; }
  /// The state, to be read once.
  StateReader& state() { return *reader_; }
  /// @throws InputError with this as the reason.
  [[noreturn]] void refuse(const std::string& reason) const;

 private:
  std::filesystem::path file_;
  std::string bytes_;
  std::optional<StateReader> reader_;
  CheckpointHeader header_;
};

/// The folder checkpoint/ of a run. It keeps the two newest checkpoints.
class CheckpointFolder {
 public:
  explicit CheckpointFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Saves a checkpoint, whole or not at all, down to the disk; older ones go. @param state writes the state
  /// @throws RunError; the older ones are still there then.
  void save(const CheckpointHeader& header, const std::function<void(StateWriter&)>& state) const;
  /// The newest one; none where there is none.
  std::optional<std::filesystem::path> newest() const;

  /// Notes that all is done up to this frame, videos included; the last checkpoint stays, to go on from.
  void mark_complete(int frames) const;
  /// The frame of that note; -1 where there is none.
  int complete_frames() const;
  void unmark_complete() const;

 private:
  std::vector<std::filesystem::path> files() const;  // by ascending frame
  void keep(std::size_t count) const;
  std::filesystem::path mark() const { return folder_ / "complete.txt"; }

  std::filesystem::path folder_;
};

}  // namespace flowskin::tools
