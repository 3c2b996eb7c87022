#include "tools/pipeline/run_directory.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <optional>
#include <string_view>

#include "common/errors.h"
#include "scenes/io/atomic_file.h"

namespace flowskin::tools {

namespace fs = std::filesystem;

namespace {

std::string numbered(const std::string& prefix, int frame, const std::string& extension) {
  return fmt::format("{}{:04}{}", prefix, frame, extension);
}

/// A name that a frame's number stands in.
struct NumberedName {
  std::string_view before, after;
};

constexpr std::array kNumberedNames{
    NumberedName{"surface/frame_", ".obj"},    NumberedName{"surface/frame_", ".ply"},
    NumberedName{"surface/frame_", ".vtp"},    NumberedName{"particles/frame_", ".ply"},
    NumberedName{"particles/frame_", ".vtp"},  NumberedName{"images/frame_", ".png"},
    NumberedName{"images/particles_", ".png"}, NumberedName{"images/compare_", ".png"},
    NumberedName{"checkpoint/frame_", ".bin"},
};

constexpr std::array<std::string_view, 18> kPlainNames{
    RunDirectory::kRecordName,
    "scene.json",
    "log.txt",
    "frames.csv",
    "contact_sheet.png",
    "surface.mp4",
    "particles.mp4",
    "compare.csv",
    "compare.md",
    "compare.svg",
    "compare.png",
    "compare_sheet.png",
    "compare.mp4",
    "surface/texture.png",
    "surface/surface.mtl",
    "surface/surface.pvd",
    "particles/particles.pvd",
    "checkpoint/complete.txt",
};

/// The number between the two; a checkpoint on the way to the first frame has -1.
std::optional<int> number_in(std::string_view name, std::string_view before, std::string_view after) {
  if (name.size() <= before.size() + after.size() || !name.starts_with(before) || !name.ends_with(after))
    return std::nullopt;
  name.remove_prefix(before.size());
  name.remove_suffix(after.size());
  int number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error != std::errc() || end != name.data() + name.size()) return std::nullopt;
  return number;
}

}  // namespace

bool RunDirectory::is_name_of_run(const std::string& name) {
  return std::find(kPlainNames.begin(), kPlainNames.end(), name) != kPlainNames.end() ||
         std::any_of(kNumberedNames.begin(), kNumberedNames.end(), [&](const NumberedName& numbered) {
           return number_in(name, numbered.before, numbered.after).has_value();
         });
}

fs::path RunDirectory::surface(int frame, const std::string& extension) const {
  return surface_folder() / numbered("frame_", frame, extension);
}
fs::path RunDirectory::particles(int frame, const std::string& extension) const {
  return particle_folder() / numbered("frame_", frame, extension);
}
fs::path RunDirectory::surface_image(int frame) const { return image_folder() / numbered("frame_", frame, ".png"); }
fs::path RunDirectory::particle_image(int frame) const {
  return image_folder() / numbered("particles_", frame, ".png");
}

fs::path RunDirectory::compare_image(int frame) const { return image_folder() / numbered("compare_", frame, ".png"); }

std::vector<fs::path> RunDirectory::folders() const {
  return {surface_folder(), particle_folder(), image_folder(), checkpoint_folder()};
}

void RunDirectory::make_folders() const {
  try {
    scenes::remove_stale_drafts(root_);
    for (const fs::path& folder : folders()) {
      fs::create_directories(folder);
      scenes::remove_stale_drafts(folder);
    }
  } catch (const fs::filesystem_error& error) {
    throw RunError(fmt::format("cannot prepare the folder {}: {}", root_.string(), error.code().message()));
  }
}

RunLock::~RunLock() {
  // Whoever has got the lock of a folder that was made here may be about to write into it.
  if (descriptor_ < 0 && !made_.empty() && made_.back() == root_) made_.pop_back();
  std::error_code ignored;
  for (auto folder = made_.rbegin(); folder != made_.rend(); ++folder) fs::remove(*folder, ignored);
  if (descriptor_ >= 0) ::close(descriptor_);
}

void RunLock::create(const RunDirectory& directory) {
  const fs::path& root = root_ = directory.root();
  std::error_code ignored;
  if (fs::exists(root, ignored) && !fs::is_directory(root, ignored))
    throw InputError(fmt::format("{} is a file; --out needs a folder", root.string()));
  constexpr int kAttempts = 100;
  constexpr std::size_t kShownOfLongNames = 255;
  int attempts = 0;
  try {
    do {
      std::vector<fs::path> missing;
      for (fs::path folder = root; !folder.empty() && !fs::exists(folder); folder = folder.parent_path())
        missing.insert(missing.begin(), folder);
      for (const fs::path& folder : missing) {
        std::error_code error;
        if (fs::create_directory(folder, error)) made_.push_back(folder);
        if (error && (error != std::errc::no_such_file_or_directory || ++attempts == kAttempts))
          throw fs::filesystem_error("cannot make the folder", folder, error);
      }
      // Another process may remove the folders that it has made, between here and there.
    } while (!take(directory));
  } catch (const fs::filesystem_error& error) {
    if (error.code() == std::errc::filename_too_long)
      throw InputError(fmt::format("{}...: no folder has so long a name", root.string().substr(0, kShownOfLongNames)));
    throw RunError(fmt::format("cannot prepare the folder {}: {}", root.string(), error.code().message()));
  }
}

bool RunLock::take(const RunDirectory& directory) {
  const int descriptor = ::open(directory.root().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return errno != ENOENT;
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    ::close(descriptor);
    throw InputError(
        fmt::format("another flowskin is already writing into {}; wait for it, stop it, or use another folder",
                    directory.root().string()));
  }
  struct stat locked {
  }, present{};
  if (::fstat(descriptor, &locked) != 0 || ::stat(directory.root().c_str(), &present) != 0 ||
      locked.st_dev != present.st_dev || locked.st_ino != present.st_ino) {
    ::close(descriptor);
    return false;
  }
  descriptor_ = descriptor;
  return true;
}

void RunDirectory::check_is_run() const {
  if (!fs::is_directory(root_))
    throw InputError(fmt::format("{} is no folder of a run: it does not exist", root_.string()));
  if (!fs::exists(scene()))
    throw InputError(fmt::format("{} is no folder of a run: it has no scene.json", root_.string()));
}

std::vector<int> RunDirectory::frames_in(const fs::path& folder, const std::string& prefix,
                                         const std::string& extension) {
  std::vector<int> frames;
  if (!fs::is_directory(folder)) return frames;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (const auto frame = number_in(entry.path().filename().string(), prefix, extension)) frames.push_back(*frame);
  }
  std::sort(frames.begin(), frames.end());
  return frames;
}

}  // namespace flowskin::tools
