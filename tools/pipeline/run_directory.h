// The folder of a run: where each file goes, and what may be replaced.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace flowskin::tools {

/// Names of the files of a run directory.
class RunDirectory {
 public:
  explicit RunDirectory(std::filesystem::path root) : root_(std::move(root)) {}

  /// Makes the folders. Files of an earlier run are removed first, so that two runs are never mixed.
  /// @throws InputError where the folder holds something that is not a run; RunError where it cannot be made.
  void prepare() const;
  /// The same for a run that goes on: nothing is removed but what a killed run left half written.
  void prepare_to_resume() const;
  /// @throws InputError where this is no finished or interrupted run.
  void check_is_run() const;

  const std::filesystem::path& root() const { return root_; }
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

  /// surface/frame_0012.obj and so on; `extension` with its dot.
  std::filesystem::path surface(int frame, const std::string& extension) const;
  std::filesystem::path particles(int frame, const std::string& extension) const;
  std::filesystem::path surface_image(int frame) const;
  std::filesystem::path particle_image(int frame) const;
  std::filesystem::path compare_image(int frame) const;

  /// Numbers of the frames whose file `folder`/`prefix`NNNN`extension` exists, ascending.
  static std::vector<int> frames_in(const std::filesystem::path& folder, const std::string& prefix,
                                    const std::string& extension);

 private:
  std::vector<std::filesystem::path> folders() const;

  std::filesystem::path root_;
};

/// Keeps other processes from running into the same folder, as long as it lives; killed processes hold no locks.
class RunLock {
 public:
  RunLock() = default;
  ~RunLock();
  RunLock(const RunLock&) = delete;
  RunLock& operator=(const RunLock&) = delete;

  /// Does nothing where the folder does not exist, where it is locked by this already, or on file systems without
  /// locks.
  /// @throws InputError where another process has it.
  void take(const RunDirectory& directory);

 private:
  int descriptor_ = -1;
};

}  // namespace flowskin::tools
