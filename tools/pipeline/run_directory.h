// The folder of a run: where each file goes, and what may be replaced.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace flowskin::tools {

/// Names of the files of a run directory.
class RunDirectory {
 public:
  /// Says which of its files FlowSkin has written (run_record.h).
  static constexpr const char* kRecordName = "flowskin_run.txt";

  explicit RunDirectory(const std::filesystem::path& root)
      : root_(root.has_filename() || !root.has_parent_path() ? root : root.parent_path()) {}

  /// Makes the folders below it that are not there, and removes what a killed run has left half written.
  /// @throws RunError where they cannot be made.
  void make_folders() const;
  /// @throws InputError where this is no finished or interrupted run.
  void check_is_run() const;

  const std::filesystem::path& root() const { return root_; }
  std::filesystem::path record() const { return root_ / kRecordName; }
  std::filesystem::path scene() const { return root_ / "scene.json"; }
  std::filesystem::path log() const { return root_ / "log.txt"; }
  std::filesystem::path frames_csv() const { return root_ / "frames.csv"; }
  std::filesystem::path contact_sheet() const { return root_ / "contact_sheet.png"; }
  std::filesystem::path surface_video() const { return root_ / "surface.mp4"; }
  std::filesystem::path particle_video() const { return root_ / "particles.mp4"; }
  std::filesystem::path compare_csv() const { return root_ / "compare.csv"; }
  std::filesystem::path compare_markdown() const { return root_ / "compare.md"; }
  /// Without its extension: .svg and .png
  std::filesystem::path compare_plots() const { return root_ / "compare"; }
  std::filesystem::path compare_sheet() const { return root_ / "compare_sheet.png"; }
  std::filesystem::path compare_video() const { return root_ / "compare.mp4"; }
  std::filesystem::path surface_folder() const { return root_ / "surface"; }
  std::filesystem::path particle_folder() const { return root_ / "particles"; }
  std::filesystem::path image_folder() const { return root_ / "images"; }
  std::filesystem::path checkpoint_folder() const { return root_ / "checkpoint"; }

  /// All four.
  std::vector<std::filesystem::path> folders() const;

  /// surface/frame_0012.obj and so on; `extension` with its dot.
  std::filesystem::path surface(int frame, const std::string& extension) const;
  std::filesystem::path particles(int frame, const std::string& extension) const;
  std::filesystem::path surface_image(int frame) const;
  std::filesystem::path particle_image(int frame) const;
  std::filesystem::path compare_image(int frame) const;

  /// Whether a file of this name, relative to the folder of a run, is one that runs write: "surface/frame_0012.obj".
  static bool is_name_of_run(const std::string& name);

  /// Numbers of the frames whose file `folder`/`prefix`NNNN`extension` exists, ascending.
  static std::vector<int> frames_in(const std::filesystem::path& folder, const std::string& prefix,
                                    const std::string& extension);

 private:
  std::filesystem::path root_;
};

/// Keeps other processes from running into the same folder, as long as it lives; killed processes hold no locks.
class RunLock {
 public:
  RunLock() = default;
  /// Folders that were made for the lock and are still empty go again, but not one whose lock another process won.
  ~RunLock();
  RunLock(const RunLock&) = delete;
  RunLock& operator=(const RunLock&) = delete;

  /// Makes the folder where there is none. @throws InputError where another process has it, or it is a file; RunError
  /// where it cannot be made.
  void create(const RunDirectory& directory);
  /// On file systems without locks there is none. @return false where the folder does not exist
  /// @throws InputError where another process has it.
  bool take(const RunDirectory& directory);

 private:
  int descriptor_ = -1;
  std::filesystem::path root_;
  std::vector<std::filesystem::path> made_;  // from the outermost
};

}  // namespace flowskin::tools
