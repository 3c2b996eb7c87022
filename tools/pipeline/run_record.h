// flowskin_run.txt of a run directory: which of its files FlowSkin has written. Nothing else there is ever removed.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tools/pipeline/run_directory.h"

namespace flowskin::tools {

/// What tells whether a file is still as it was written.
struct FileStamp {
  std::int64_t bytes = 0;
  std::int64_t written = 0;  ///< Time (ns since 1970).

  bool operator==(const FileStamp&) const = default;
};

/// Of a plain file; nothing for links, folders and what is not there.
std::optional<FileStamp> stamp_of(const std::filesystem::path& file);

/// The record as read. A last line without its end, which a full disk may leave, does not count.
class RunRecord {
 public:
  /// Nothing where there is none. @throws InputError where the file is something else.
  static std::optional<RunRecord> read(const RunDirectory& directory);

  /// Which scene was run (a file name, or what was tracked).
  const std::string& scene() const { return scene_; }
  /// Frames of a run that ended; nothing: it was interrupted.
  std::optional<int> frames_done() const { return frames_done_; }
  /// Whether FlowSkin has written a file of this name, relative to the folder.
  bool names(const std::string& name) const;
  const std::map<std::string, std::vector<FileStamp>>& files() const { return files_; }
  /// Whether the file is one that FlowSkin has written, with the time and length that it had then.
  bool is_unchanged(const RunDirectory& directory, const std::string& name) const;

 private:
  void take(const std::string& line);

  std::string scene_;
  std::optional<int> frames_done_;
  std::map<std::string, std::vector<FileStamp>> files_;  // each as often as it was written
  std::set<std::string> growing_;                        // files that are written to all the time
};

/// Begins the record of a new run, instead of the one that is there. @throws RunError
void begin_record(const RunDirectory& directory, const std::string& scene);

/// Adds to the record, a line before each file gets its name, as long as it lives.
class RunRecorder {
 public:
  enum class Work { whole_run, pictures };

  /// @throws RunError where it cannot be written
  RunRecorder(const RunDirectory& directory, Work work);
  ~RunRecorder();
  RunRecorder(const RunRecorder&) = delete;
  RunRecorder& operator=(const RunRecorder&) = delete;

  /// The files of frames that were written since the last call count as there from now on.
  void keep_frame();
  /// The run has ended, with so many frames after the first; that is on the disk then.
  void finish(int frames);
  /// What has become of the folder and of the files of its frames meanwhile; empty: all are there.
  std::string loss() const;

 private:
  bool is_in_place() const;
  void record(const std::filesystem::path& file, const std::filesystem::path& draft, bool durable);
  void append(const std::string& line);

  const RunDirectory directory_;
  int descriptor_ = -1;
  dev_t device_ = 0;  // of the folder, which may be replaced by another one of its name
  ino_t inode_ = 0;
  std::set<std::string> names_;    // of the files of the frames
  std::set<std::string> written_;  // of those of the frame that is being written
};

}  // namespace flowskin::tools
