#include "tools/pipeline/run_record.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <sstream>

#include "common/errors.h"
#include "scenes/io/atomic_file.h"
#include "scenes/io/read_bytes.h"

namespace flowskin::tools {

namespace fs = std::filesystem;

namespace {

constexpr const char* kHead = "flowskin run 1";
constexpr const char* kExplanation =
    "# Files of this folder that FlowSkin has written: name, bytes, time (ns). --resume and --overwrite need this.";
constexpr const char* kBegun = "begun";

bool is_of_a_frame(const std::string& name) {
  return name.starts_with("surface/frame_") || name.starts_with("particles/frame_");
}

/// A scene's name as one line.
std::string on_one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace

std::optional<FileStamp> stamp_of(const fs::path& file) {
  struct stat status {};
  if (::lstat(file.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  return FileStamp{status.st_size, std::int64_t{status.st_mtim.tv_sec} * 1000000000 + status.st_mtim.tv_nsec};
}

std::optional<RunRecord> RunRecord::read(const RunDirectory& directory) {
  std::error_code error;
  const fs::file_type type = fs::symlink_status(directory.record(), error).type();
  if (type == fs::file_type::not_found) return std::nullopt;
  const std::string text = type == fs::file_type::regular ? scenes::read_bytes(directory.record()) : "";
  if (!text.starts_with(std::string(kHead) + "\n"))
    throw InputError(
        fmt::format("{} is not the record of a run that this program reads (it should begin with \"{}\"); move it "
                    "away, or give another folder to --out",
                    directory.record().string(), kHead));
  std::istringstream lines(text.substr(0, text.rfind('\n')));
  RunRecord record;
  for (std::string line; std::getline(lines, line);) record.take(line);
  return record;
}

void RunRecord::take(const std::string& line) {
  std::istringstream words(line);
  std::string kind, name;
  words >> kind;
  if (kind == "scene" && line.size() > 6) scene_ = line.substr(6);
  if (kind == kBegun) frames_done_.reset();
  if (int frames = 0; kind == "done" && words >> frames) frames_done_ = frames;
  if (kind == "grows" && words >> name) {
    files_[name];
    growing_.insert(name);
  }
  FileStamp stamp;
  if (kind == "file" && words >> name >> stamp.bytes >> stamp.written) {
    files_[name].push_back(stamp);
    growing_.erase(name);
  }
}

bool RunRecord::names(const std::string& name) const {
  return name == RunDirectory::kRecordName || files_.count(name) > 0;
}

bool RunRecord::is_unchanged(const RunDirectory& directory, const std::string& name) const {
  if (name == RunDirectory::kRecordName || growing_.count(name) > 0) return true;
  const auto stamps = files_.find(name);
  const auto stamp = stamp_of(directory.root() / name);
  return stamps != files_.end() && stamp &&
         std::find(stamps->second.begin(), stamps->second.end(), *stamp) != stamps->second.end();
}

void begin_record(const RunDirectory& directory, const std::string& scene) {
  scenes::AtomicFile file(directory.record());
  file.write(fmt::format("{}\n{}\nscene {}\n{}\n", kHead, kExplanation, on_one_line(scene), kBegun));
  file.commit(true);
}

RunRecorder::RunRecorder(const RunDirectory& directory, Work work) : directory_(directory) {
  if (const auto record = RunRecord::read(directory))
    for (const auto& [name, stamps] : record->files())
      if (is_of_a_frame(name)) names_.insert(name);
  struct stat status {};
  if (::stat(directory.root().c_str(), &status) != 0) scenes::fail_to_write(directory.record(), errno);
  device_ = status.st_dev;
  inode_ = status.st_ino;
  descriptor_ = ::open(directory.record().c_str(), O_RDWR | O_APPEND | O_CLOEXEC | O_NOFOLLOW);
  if (descriptor_ < 0) scenes::fail_to_write(directory.record(), errno);
  try {
    // Where a full disk has left half a line, that is ended.
    char last = '\n';
    const off_t size = ::lseek(descriptor_, 0, SEEK_END);
    if (size > 0 && ::pread(descriptor_, &last, 1, size - 1) == 1 && last != '\n') append("");
    if (work == Work::whole_run) {
      append(kBegun);
      append("grows " + directory.log().filename().string());
    }
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
  scenes::observe_commits(
      [this](const fs::path& file, const fs::path& draft, bool durable) { record(file, draft, durable); });
}

RunRecorder::~RunRecorder() {
  scenes::observe_commits({});
  ::close(descriptor_);
}

bool RunRecorder::is_in_place() const {
  struct stat status {};
  return ::stat(directory_.root().c_str(), &status) == 0 && status.st_dev == device_ && status.st_ino == inode_;
}

void RunRecorder::record(const fs::path& file, const fs::path& draft, bool durable) {
  const std::string name = file.lexically_relative(directory_.root()).generic_string();
  if (name.empty() || name.starts_with("..")) return;
  if (!is_in_place())
    throw RunError(fmt::format("the folder {} was replaced by another one during the run; {} was not written",
                               directory_.root().string(), file.string()));
  const FileStamp stamp = stamp_of(draft).value_or(FileStamp{});
  append(fmt::format("file {} {} {}", name, stamp.bytes, stamp.written));
  if (durable) ::fdatasync(descriptor_);
  if (is_of_a_frame(name)) written_.insert(name);
}

void RunRecorder::keep_frame() { names_.merge(written_); }

/// In one go: other processes may add lines as well.
void RunRecorder::append(const std::string& line) {
  const std::string text = line + "\n";
  ssize_t written = 0;
  do written = ::write(descriptor_, text.data(), text.size());
  while (written < 0 && errno == EINTR);
  if (written == static_cast<ssize_t>(text.size())) return;
  scenes::fail_to_write(directory_.record(), written < 0 ? errno : ENOSPC);
}

void RunRecorder::finish(int frames) {
  const FileStamp log = stamp_of(directory_.log()).value_or(FileStamp{});
  append(fmt::format("file {} {} {}", directory_.log().filename().string(), log.bytes, log.written));
  append(fmt::format("done {}", frames));
  ::fdatasync(descriptor_);
}

std::string RunRecorder::loss() const {
  const std::string root = directory_.root().string();
  if (!is_in_place()) return fmt::format("{} was removed or replaced during the run: its frames are not there", root);
  std::error_code error;
  std::size_t gone = 0;
  for (const std::string& name : names_) gone += !fs::exists(directory_.root() / name, error);
  if (gone == 0) return "";
  return fmt::format("{} of the {} files of frames that were written are no longer in {}", gone, names_.size(), root);
}

}  // namespace flowskin::tools
