#include "scenes/io/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include "common/errors.h"

namespace flowskin::scenes {
namespace {

namespace fs = std::filesystem;

/// What helps against an error of the operating system.
std::string advice(int error, const fs::path& folder) {
  switch (error) {
    case ENOSPC:
    case EDQUOT:
      return "free some space there, or write to a folder on another disk";
    case EFBIG:
      return "the file is larger than the system or the limit of this session (ulimit -f) allows";
    case ENOENT:
    case ENOTDIR:
      return "make the folder " + folder.string() + " first (was it removed meanwhile?), or write elsewhere";
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

/// Names of the drafts of this process, for remove_drafts(): plain memory, since it runs in a signal handler.
struct Slot {
  std::atomic<bool> taken{false}, ready{false};
  std::array<char, 4096> name{};
};
std::array<Slot, 16> slots;

/// A slot with this name; -1 where there is none: then a second signal leaves the draft behind.
int take_slot(const std::string& name) {
  for (std::size_t i = 0; i < slots.size(); ++i) {
    bool expected = false;
    if (name.size() >= slots[i].name.size() || !slots[i].taken.compare_exchange_strong(expected, true)) continue;
    std::memcpy(slots[i].name.data(), name.c_str(), name.size() + 1);
    slots[i].ready = true;
    return static_cast<int>(i);
  }
  return -1;
}

CommitObserver& commit_observer() {
  static CommitObserver observer;
  return observer;
}

/// The batch that waits for its end; files come from any thread.
FileBatch* open_batch = nullptr;
std::mutex batch_mutex;

fs::path folder_of(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : fs::path("."); }

/// Its names reach the disk. Folders that cannot be opened have none to lose.
void sync_folder(const fs::path& path) {
  const int folder = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  ::fsync(folder);
  ::close(folder);
}

/// Whether a file is named as AtomicFile names drafts: .NAME.PROCESS-COUNT.part
bool is_draft(std::string_view name) {
  constexpr std::string_view kEnd = ".part", kDigits = "0123456789";
  if (!name.starts_with('.') || !name.ends_with(kEnd)) return false;
  name.remove_suffix(kEnd.size());
  const std::size_t dash = name.find_last_not_of(kDigits);
  if (dash == std::string_view::npos || name[dash] != '-' || dash + 1 == name.size()) return false;
  name = name.substr(0, dash);
  const std::size_t dot = name.find_last_not_of(kDigits);
  return dot != std::string_view::npos && dot > 0 && name[dot] == '.' && dot + 1 < name.size();
}

void free_slot(int slot) {
  if (slot < 0) return;
  slots[static_cast<std::size_t>(slot)].ready = false;
  slots[static_cast<std::size_t>(slot)].taken = false;
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& file) : file_(file), folder_(folder_of(file)) {
  if (!file.has_filename()) throw RunError("cannot write \"" + file.string() + "\": this names no file");
  // The name tells processes and threads apart; a draft that a killed process left behind is passed over.
  static std::atomic<unsigned> counter{0};
  do {
    draft_ = folder_ / ("." + file.filename().string() + "." + std::to_string(::getpid()) + "-" +
                        std::to_string(counter.fetch_add(1)) + ".part");
    descriptor_ = ::open(draft_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  } while (descriptor_ < 0 && (errno == EEXIST || errno == EINTR));
  if (descriptor_ < 0) fail(errno);
  slot_ = take_slot(draft_.string());
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!renamed_ && !draft_.empty()) ::unlink(draft_.c_str());
  free_slot(slot_);
}

void AtomicFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(errno);
    if (written == 0) fail(ENOSPC);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void AtomicFile::commit(bool durable) {
  // File systems that cannot do it say EINVAL.
  if (durable && ::fsync(descriptor_) != 0 && errno != EINVAL && errno != EINTR) fail(errno);
  // Network file systems tell of a full disk only here. The descriptor is gone even where close() fails.
  const int result = ::close(descriptor_);
  descriptor_ = -1;
  if (result != 0 && errno != EINTR) fail(errno);
  if (commit_observer()) commit_observer()(file_, draft_, durable);
  if (const std::scoped_lock lock(batch_mutex); open_batch != nullptr && !durable) {
    open_batch->waiting_.push_back({file_, draft_, slot_});
    draft_.clear();
    slot_ = -1;
    return;
  }
  if (::rename(draft_.c_str(), file_.c_str()) != 0) fail(errno);
  renamed_ = true;
  if (durable) sync_folder(folder_);
}

FileBatch::FileBatch() {
  const std::scoped_lock lock(batch_mutex);
  if (open_batch != nullptr) throw std::logic_error("a batch of files within another one");
  open_batch = this;
}

FileBatch::~FileBatch() {
  const std::scoped_lock lock(batch_mutex);
  open_batch = nullptr;
  for (const Waiting& waiting : waiting_) {
    ::unlink(waiting.draft.c_str());
    free_slot(waiting.slot);
  }
}

void FileBatch::commit() {
  if (waiting_.empty()) return;
  // One call for all of them takes a fifth of the time of one for each; the record of the run goes with it.
  sync_file_system(folder_of(waiting_.front().file));
  std::set<fs::path> folders;
  while (!waiting_.empty()) {
    const Waiting& first = waiting_.front();
    if (::rename(first.draft.c_str(), first.file.c_str()) != 0) fail_to_write(first.file, errno);
    folders.insert(folder_of(first.file));
    free_slot(first.slot);
    waiting_.erase(waiting_.begin());
  }
  for (const fs::path& folder : folders) sync_folder(folder);
}

void sync_file_system(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) fail_to_write(folder, errno);
  const int error = ::syncfs(descriptor) != 0 ? errno : 0;
  ::close(descriptor);
  if (error != 0 && error != EINVAL && error != ENOSYS && error != EINTR) fail_to_write(folder, error);
}

void AtomicFile::fail(int error) const { fail_to_write(file_, error); }

void fail_to_write(const fs::path& file, int error) {
  throw RunError("cannot write " + file.string() + ": " + std::generic_category().message(error) + "; " +
                 advice(error, folder_of(file)));
}

void observe_commits(CommitObserver observer) { commit_observer() = std::move(observer); }

void write_file(const fs::path& file, std::string_view bytes) {
  AtomicFile draft(file);
  draft.write(bytes);
  draft.commit();
}

void remove_drafts() noexcept {
  for (const Slot& slot : slots)
    if (slot.ready) ::unlink(slot.name.data());
}

void remove_stale_drafts(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code ignored;
    if (is_draft(entry->path().filename().string()) && !entry->is_directory(ignored))
      fs::remove(entry->path(), ignored);
  }
}

}  // namespace flowskin::scenes
