#include "tools/pipeline/run_directory.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>

#include "common/errors.h"
#include "scenes/io/atomic_file.h"

namespace flowskin::tools {

namespace fs = std::filesystem;

namespace {

std::string numbered(const std::string& prefix, int frame, const std::string& extension) {
  return fmt::format("{}{:04}{}", prefix, frame, extension);
}

}  // namespace

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

void RunDirectory::prepare() const {
  try {
    if (fs::exists(root_) && !fs::is_directory(root_))
      throw InputError(fmt::format("{} is a file; --out needs a folder", root_.string()));
    if (fs::exists(root_) && !fs::is_empty(root_)) {
      if (!fs::exists(scene()) && !fs::exists(log()))
        throw InputError(fmt::format("{} is not empty and holds no earlier run; give an empty or new folder to --out",
                                     root_.string()));
      for (const fs::path& old :
           {surface_folder(), particle_folder(), image_folder(), checkpoint_folder(), scene(), log(), frames_csv(),
            contact_sheet(), surface_video(), particle_video(), compare_csv(), compare_markdown(), compare_sheet(),
            compare_video(), root_ / "compare.svg", root_ / "compare.png"})
        fs::remove_all(old);
    }
    for (const fs::path& folder : folders()) fs::create_directories(folder);
    scenes::remove_stale_drafts(root_);
  } catch (const fs::filesystem_error& error) {
    throw RunError(fmt::format("cannot prepare the folder {}: {}", root_.string(), error.code().message()));
  }
}

std::vector<fs::path> RunDirectory::folders() const {
  return {surface_folder(), particle_folder(), image_folder(), checkpoint_folder()};
}

void RunDirectory::prepare_to_resume() const {
  try {
    for (const fs::path& folder : folders()) {
      fs::create_directories(folder);
      scenes::remove_stale_drafts(folder);
    }
    scenes::remove_stale_drafts(root_);
  } catch (const fs::filesystem_error& error) {
    throw RunError(fmt::format("cannot prepare the folder {}: {}", root_.string(), error.code().message()));
  }
}

RunLock::~RunLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void RunLock::take(const RunDirectory& directory) {
  if (descriptor_ >= 0) return;
  descriptor_ = ::open(directory.root().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor_ < 0 || ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  ::close(descriptor_);
  descriptor_ = -1;
  throw InputError(
      fmt::format("another flowskin is already writing into {}; wait for it, stop it, or give another folder "
                  "to --out",
                  directory.root().string()));
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
    const std::string name = entry.path().filename().string();
    if (name.size() <= prefix.size() + extension.size() || name.rfind(prefix, 0) != 0 ||
        entry.path().extension() != extension)
      continue;
    const char* first = name.data() + prefix.size();
    const char* last = name.data() + name.size() - extension.size();
    int frame = 0;
    if (const auto [end, error] = std::from_chars(first, last, frame); error == std::errc() && end == last)
      frames.push_back(frame);
  }
  std::sort(frames.begin(), frames.end());
  return frames;
}

}  // namespace flowskin::tools
