#include "tools/pipeline/checkpoint.h"

#include <fmt/format.h>

#include <fstream>

#include "common/errors.h"
#include "scenes/io/atomic_file.h"
#include "scenes/io/checksum.h"
#include "scenes/io/read_bytes.h"
#include "tools/pipeline/run_directory.h"
#include "tools/report/run_log.h"

namespace flowskin::tools {

namespace {

namespace fs = std::filesystem;
using scenes::checksum;

// magic | format version (u32) | header and state | length of all before (u64) | CRC-32 of all before (u32) | end
constexpr std::string_view kMagic = "flowskin checkpoint\n";
constexpr std::string_view kEnd = "the end\n";
constexpr std::uint32_t kFormatVersion = 5;
constexpr std::size_t kHeadSize = kMagic.size() + sizeof(std::uint32_t);
constexpr std::size_t kTailSize = sizeof(std::uint64_t) + sizeof(std::uint32_t) + kEnd.size();
constexpr std::size_t kKept = 2;

template <class Number>
Number number_at(std::string_view bytes, std::size_t place) {
  Number number{};
  StateReader reader(bytes.substr(place, sizeof(Number)));
  reader(number);
  return number;
}

}  // namespace

void Checkpoint::refuse(const std::string& reason) const {
  throw InputError(fmt::format("{} {}", file_.string(), reason));
}

Checkpoint::Checkpoint(fs::path file) : file_(std::move(file)), bytes_(scenes::read_bytes(file_)) {
  const std::string_view bytes = bytes_;
  const std::string remedy = "; delete it to resume from the one before, if there is one, or run the scene anew";
  if (!bytes.starts_with(kMagic)) refuse("is no checkpoint of flowskin" + remedy);
  if (bytes.size() < kHeadSize + kTailSize || !bytes.ends_with(kEnd)) refuse("is cut short" + remedy);
  const auto version = number_at<std::uint32_t>(bytes, kMagic.size());
  if (version != kFormatVersion)
    refuse(
        fmt::format("has format {}, but this program reads format {}: resume with the flowskin that wrote it, or run "
                    "the scene anew",
                    version, kFormatVersion));
  const std::size_t size = bytes.size() - kTailSize;
  if (number_at<std::uint64_t>(bytes, size) != size) refuse("is cut short" + remedy);
  if (number_at<std::uint32_t>(bytes, size + sizeof(std::uint64_t)) != checksum(0, bytes.substr(0, size)))
    refuse("is damaged: its checksum is wrong" + remedy);
  reader_.emplace(bytes.substr(kHeadSize, size - kHeadSize));
  try {
    (*reader_)(header_);
  } catch (const StateError& error) {
    refuse(std::string("contradicts itself: ") + error.what() + remedy);
  }
  if (header_.program != version_text())
    refuse(
        fmt::format("was written by {}, but this is {}, whose results may differ: resume with that version, or run "
                    "the scene anew",
                    header_.program, version_text()));
}

void CheckpointFolder::save(const CheckpointHeader& header, const std::function<void(StateWriter&)>& state) const {
  scenes::AtomicFile file(folder_ / fmt::format("frame_{:04}.bin", header.frame));
  std::uint64_t size = 0;
  std::uint32_t crc = 0;
  const auto put = [&](std::string_view bytes) {
    size += bytes.size();
    crc = checksum(crc, bytes);
    file.write(bytes);
  };
  put(kMagic);
  StateWriter writer(put);
  writer(kFormatVersion, header);
  state(writer);
  writer.flush();
  StateWriter tail([&](std::string_view bytes) { file.write(bytes); });
  tail(size, crc);
  tail.flush();
  file.write(kEnd);
  file.commit(true);
  keep(kKept);
}

std::vector<fs::path> CheckpointFolder::files() const {
  std::vector<fs::path> files;
  for (const int frame : RunDirectory::frames_in(folder_, "frame_", ".bin"))
    files.push_back(folder_ / fmt::format("frame_{:04}.bin", frame));
  return files;
}

void CheckpointFolder::keep(std::size_t count) const {
  const std::vector<fs::path> all = files();
  std::error_code ignored;
  for (std::size_t i = 0; i + count < all.size(); ++i) fs::remove(all[i], ignored);
}

std::optional<fs::path> CheckpointFolder::newest() const {
  const std::vector<fs::path> all = files();
  return all.empty() ? std::nullopt : std::optional(all.back());
}

void CheckpointFolder::mark_complete(int frames) const {
  scenes::write_file(mark(), fmt::format("{}\n", frames));
  keep(1);
}

int CheckpointFolder::complete_frames() const {
  int frames = -1;
  std::error_code error;
  if (fs::is_regular_file(mark(), error)) std::ifstream(mark()) >> frames;
  return frames;
}

void CheckpointFolder::unmark_complete() const {
  std::error_code ignored;
  fs::remove(mark(), ignored);
}

}  // namespace flowskin::tools
