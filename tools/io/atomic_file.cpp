#include "tools/io/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <string>
#include <system_error>

#include "tools/errors.h"

namespace flowskin::tools {
namespace {

/// What helps against an error of the operating system.
std::string advice(int error, const std::filesystem::path& folder) {
  switch (error) {
    case ENOSPC:
    case EDQUOT:
      return "free some space there, or write to a folder on another disk";
    case EFBIG:
      return "the file is larger than the system or the limit of this session (ulimit -f) allows";
    case ENOENT:
    case ENOTDIR:
      return "make the folder " + folder.string() + " first, or write elsewhere";
    case EACCES:
    case EPERM:
    case EROFS:
      return "write to a folder that you may write to";
    case EISDIR:
    case EEXIST:
    case ENOTEMPTY:
      return "a folder has the name of the file: move it away";
    default:
      return "check the disk, or write to another folder";
  }
}

/// The file being written aside; removed by the destructor unless it was renamed.
class Draft {
 public:
  explicit Draft(const std::filesystem::path& file)
      : file_(file), folder_(file.has_parent_path() ? file.parent_path() : std::filesystem::path(".")) {
    // The name tells processes and threads apart; a draft that a killed process left behind is passed over.
    static std::atomic<unsigned> counter{0};
    do {
      draft_ = folder_ / ("." + file.filename().string() + "." + std::to_string(::getpid()) + "-" +
                          std::to_string(counter.fetch_add(1)) + ".part");
      descriptor_ = ::open(draft_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    } while (descriptor_ < 0 && (errno == EEXIST || errno == EINTR));
    if (descriptor_ < 0) fail(errno);
  }
  ~Draft() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!renamed_) ::unlink(draft_.c_str());
  }
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;

  void write(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail(errno);
      if (written == 0) fail(ENOSPC);
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
  }

  /// Network file systems tell of a full disk only here. The descriptor is gone even where close() fails.
  void close() {
    const int result = ::close(descriptor_);
    descriptor_ = -1;
    if (result != 0 && errno != EINTR) fail(errno);
  }

  void rename() {
    if (::rename(draft_.c_str(), file_.c_str()) != 0) fail(errno);
    renamed_ = true;
  }

 private:
  [[noreturn]] void fail(int error) const {
    throw RunError("cannot write " + file_.string() + ": " + std::generic_category().message(error) + "; " +
                   advice(error, folder_));
  }

  std::filesystem::path file_, folder_, draft_;
  int descriptor_ = -1;
  bool renamed_ = false;
};

}  // namespace

void write_file(const std::filesystem::path& file, std::string_view bytes) {
  if (!file.has_filename()) throw RunError("cannot write \"" + file.string() + "\": this names no file");
  Draft draft(file);
  draft.write(bytes);
  draft.close();
  draft.rename();
}

}  // namespace flowskin::tools
