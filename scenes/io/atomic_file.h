// Files that are written whole or not at all.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

namespace flowskin::scenes {

/// A file in the making, written aside under a name that begins with a dot and ends with .part.
class AtomicFile {
 public:
  /// @throws RunError as write_file does, all functions.
  explicit AtomicFile(const std::filesystem::path& file);
  /// Without commit() nothing is left behind.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::string_view bytes);
  /// The file in the making, for another program to write.
  const std::filesystem::path& draft() const { return draft_; }
  /// Gives the file its name; within a FileBatch, later. `durable`: the bytes and the name have reached the disk
  /// itself, whatever happens then, and no batch is waited for.
  void commit(bool durable = false);

 private:
  [[noreturn]] void fail(int error) const;

  std::filesystem::path file_, folder_, draft_;
  int descriptor_ = -1;
  int slot_ = -1;
  bool renamed_ = false;
};

/// Writes `bytes` aside, checks that they reached the disk's file system, and renames to `file`.
/// @throws RunError naming the file and the reason (no space, no permission, no such directory); nothing is left
/// behind.
void write_file(const std::filesystem::path& file, std::string_view bytes);

/// Files that get their names together, once the bytes of all of them are on the disk: as long as it lives, all that
/// are written in this process. After a power cut, as after a kill, a file that is there is whole.
class FileBatch {
 public:
  /// There is one at a time. @throws std::logic_error where there are two.
  FileBatch();
  /// Without commit() nothing is left behind.
  ~FileBatch();
  FileBatch(const FileBatch&) = delete;
  FileBatch& operator=(const FileBatch&) = delete;

  /// The files, their names, and whatever else has been written to the same file system are on the disk then.
  /// @throws RunError; the files that have not got their names yet are left out.
  void commit();

 private:
  friend class AtomicFile;
  struct Waiting {
    std::filesystem::path file, draft;
    int slot;
  };

  std::vector<Waiting> waiting_;
};

/// All that has been written to the file system of this folder is on the disk then. @throws RunError
void sync_file_system(const std::filesystem::path& folder);

/// Is told of each file that is whole but has not got its name yet: what it says comes before the file, even where the
/// program is killed. Where it throws, the file does not get its name.
using CommitObserver =
    std::function<void(const std::filesystem::path& file, const std::filesystem::path& draft, bool durable)>;
/// There is one for the whole process, since those who write files know nothing of runs. Empty: none.
void observe_commits(CommitObserver observer);

/// @throws RunError for an error number of the operating system, saying what helps.
[[noreturn]] void fail_to_write(const std::filesystem::path& file, int error);

/// Removes the files that this process is just writing aside. Safe in a signal handler, before the process ends.
void remove_drafts() noexcept;

/// Removes the drafts that killed processes left behind in a folder (not below it).
void remove_stale_drafts(const std::filesystem::path& folder);

}  // namespace flowskin::scenes
