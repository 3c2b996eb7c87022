// Checkpoints: the file; and, with a right checksum, what is in it, restored into a solver and a tracker.
#include <unistd.h>

#include <cstring>
#include <stdexcept>

#include "scenes/io/checksum.h"
#include "scenes/io/read_bytes.h"
#include "scenes/scene_file.h"
#include "scenes/settings_in_metres.h"
#include "scenes/sources/make_source.h"
#include "tests/fuzz/fuzz.h"
#include "tools/pipeline/checkpoint.h"
#include "tools/pipeline/tracker_bridge.h"
#include "tools/report/run_log.h"

namespace {

using namespace flowskin;
namespace fs = std::filesystem;

constexpr std::size_t kHead = 24, kTail = 20;  // bytes before and behind what the checksum is of

/// Of the two, at the start.
struct Parts {
  std::unique_ptr<scenes::ParticleSource> source;
  tracking::Tracker tracker;
};

Parts make_parts() {
  static const scenes::Scene scene = scenes::parse_scene(
      R"({"particles": {"spacing": 0.05}, "simulation": {"max_speed": 2},
          "bodies": [{"shape": "block", "min": [0, 0, 0], "max": [0.1, 0.1, 0.05]}]})",
      "tiny.json", ".");
  auto source = scenes::make_source(scene);
  tracking::Tracker tracker(scenes::settings_in_metres(scene), tools::to_particles(source->state()));
  return {std::move(source), std::move(tracker)};
}

/// A sound checkpoint of this program.
std::string make_checkpoint() {
  const Parts parts = make_parts();
  const fs::path folder = fs::temp_directory_path() / ("flowskin_fuzz_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  tools::CheckpointFolder(folder).save({tools::version_text(), "{}", {}, "", 0}, [&](StateWriter& writer) {
    parts.source->save(writer);
    writer(parts.tracker.state());
  });
  std::string bytes = scenes::read_bytes(folder / "frame_0000.bin");
  fs::remove_all(folder);
  return bytes;
}

/// The input as changes of the sound one: how much is cut off, then places and what is written there.
std::string altered(std::string bytes, std::string_view changes) {
  const auto take = [&](auto& number) {
    if (changes.size() < sizeof number) return false;
    std::memcpy(&number, changes.data(), sizeof number);
    changes.remove_prefix(sizeof number);
    return true;
  };
  std::uint16_t cut = 0;
  std::uint32_t place = 0;
  std::uint64_t value = 0;
  take(cut);
  const std::size_t size = bytes.size() - kTail - cut % (bytes.size() - kTail - kHead - sizeof value);
  bytes.erase(size, bytes.size() - kTail - size);
  while (take(place) && take(value)) {
    // Four bytes or eight: numbers of both lengths are in it.
    const std::size_t length = place >> 31 ? 4 : 8;
    std::memcpy(bytes.data() + kHead + (place & 0x7fffffff) % (size - kHead - length + 1), &value, length);
  }
  return bytes;
}

/// With the length and the checksum that belong to the bytes.
std::string with_checksum(std::string bytes) {
  const std::uint64_t size = bytes.size() - kTail;
  std::memcpy(bytes.data() + size, &size, sizeof size);
  const std::uint32_t sum = scenes::checksum(0, std::string_view(bytes).substr(0, size));
  std::memcpy(bytes.data() + size + sizeof size, &sum, sizeof sum);
  return bytes;
}

/// A state that does not fit is refused. All inputs go into the same two: what an earlier one left there must not
/// matter.
void restore(StateReader& reader) {
  static Parts parts = make_parts();
  try {
    parts.source->restore(reader);
    tracking::TrackerState state;
    reader(state);
    parts.tracker.restore(std::move(state));
  } catch (const StateError&) {
  } catch (const std::invalid_argument&) {
  }
}

void read_checkpoint(std::string_view bytes) {
  const fuzz::MemoryFile file(bytes);
  tools::Checkpoint checkpoint(file.path());
  restore(checkpoint.state());
}

void read_altered(std::string_view changes) {
  static const std::string sound = make_checkpoint();
  read_checkpoint(with_checksum(altered(sound, changes)));
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fuzz::read(data, size, read_checkpoint) | fuzz::read(data, size, read_altered);
}
