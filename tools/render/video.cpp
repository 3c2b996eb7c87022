#include "tools/render/video.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <system_error>

#include "common/errors.h"
#include "scenes/io/atomic_file.h"
#include "tools/render/child_process.h"

namespace flowskin::tools {
namespace {

namespace fs = std::filesystem;

std::string last_lines(const std::string& text, int count) {
  std::size_t begin = text.find_last_not_of('\n');
  if (begin == std::string::npos) return "(it said nothing)";
  const std::size_t end = begin + 1;
  while (count-- > 0 && begin != std::string::npos)
    begin = begin == 0 ? std::string::npos : text.rfind('\n', begin - 1);
  return text.substr(begin == std::string::npos ? 0 : begin + 1, end - (begin == std::string::npos ? 0 : begin + 1));
}

// ffmpeg looks for the number in the whole path: a % in the folder's name must be doubled. An absolute path is neither
// taken for an option nor for a protocol.
std::string input_pattern(const fs::path& pattern) {
  std::string folder;
  for (const char c : fs::absolute(pattern).parent_path().string()) folder.append(c == '%' ? 2 : 1, c);
  return folder + "/" + pattern.filename().string();
}

// H.264 with 4:2:0 colour needs even sizes: an odd last row or column is cut off. The colours are turned to those of HD
// video, and the file says so; accurate rounding is the same on every machine.
constexpr const char* kPictureFilter =
    "crop=trunc(iw/2)*2:trunc(ih/2)*2:0:0,"
    "scale=flags=bicubic+accurate_rnd+full_chroma_int+bitexact:out_color_matrix=bt709:out_range=tv,format=yuv420p";

// The same bytes each time: x264 divides the work by its number of threads, so that is fixed, and files carry no dates.
std::vector<std::string> ffmpeg_arguments(const fs::path& pattern, double frame_rate, const fs::path& file) {
  const std::string rate = fmt::format("{}", frame_rate), input = input_pattern(pattern), output = file.string();
  return {"ffmpeg",
          "-nostdin",
          "-hide_banner",
          "-loglevel",
          "error",
          "-y",
          "-f",
          "image2",
          "-framerate",
          rate,
          "-i",
          input,
          "-filter_threads",
          "1",
          "-vf",
          kPictureFilter,
          "-colorspace",
          "bt709",
          "-color_primaries",
          "bt709",
          "-color_trc",
          "bt709",
          "-color_range",
          "tv",
          "-c:v",
          "libx264",
          "-preset",
          "medium",
          "-crf",
          "18",
          "-threads",
          "2",
          "-map_metadata",
          "-1",
          "-fflags",
          "+bitexact",
          "-flags:v",
          "+bitexact",
          "-movflags",
          "+faststart",
          "-f",
          "mp4",
          output};
}

}  // namespace

bool have_ffmpeg() {
  const char* path = std::getenv("PATH");
  if (path == nullptr) return false;
  std::string_view rest = path;
  for (;;) {
    const std::size_t colon = rest.find(':');
    const fs::path program = fs::path(rest.substr(0, colon)) / "ffmpeg";
    std::error_code error;
    if (fs::is_regular_file(program, error) && ::access(program.c_str(), X_OK) == 0) return true;
    if (colon == std::string_view::npos) return false;
    rest.remove_prefix(colon + 1);
  }
}

void encode_video(const fs::path& pattern, double frame_rate, const fs::path& file) {
  if (!(frame_rate > 0 && std::isfinite(frame_rate))) {
    throw InputError(
        fmt::format("a video of {} frames per second cannot be made: expected a positive number", frame_rate));
  }
  if (!have_ffmpeg()) {
    throw RunError(
        fmt::format("{} was not made: no ffmpeg on the path (on Debian: apt-get install ffmpeg); "
                    "the pictures are in {}",
                    file.string(), pattern.parent_path().string()));
  }
  scenes::AtomicFile draft(file);
  const ChildOutcome outcome = run_child(ffmpeg_arguments(pattern, frame_rate, fs::absolute(draft.draft())));
  if (outcome.status != 0)
    throw RunError(fmt::format("{} was not made from {}: ffmpeg failed:\n{}", file.string(), pattern.string(),
                               last_lines(outcome.errors, 4)));
  draft.commit();
}

}  // namespace flowskin::tools
