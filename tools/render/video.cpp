#include "tools/render/video.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <system_error>

#include "common/errors.h"

namespace flowskin::tools {
namespace {

namespace fs = std::filesystem;

// What a child process left behind.
struct Outcome {
  int status = -1;     // exit status; -1 where it was killed or never ran
  std::string errors;  // its standard error
};

std::string read_all(int descriptor) {
  std::string text;
  std::array<char, 4096> buffer{};
  for (;;) {
    const ssize_t got = ::read(descriptor, buffer.data(), buffer.size());
    if (got > 0) text.append(buffer.data(), std::size_t(got));
    if (got == 0 || (got < 0 && errno != EINTR)) return text;
  }
}

// Runs a program found on the path, without a shell: arguments may contain anything.
Outcome run_program(const std::vector<std::string>& arguments) {
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);

  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0)
    throw RunError(fmt::format("no pipe to {}: {}", arguments[0], std::strerror(errno)));
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
  pid_t child = 0;
  const int error = posix_spawnp(&child, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  Outcome outcome;
  if (error != 0) {
    outcome.errors = std::strerror(error);
  } else {
    outcome.errors = read_all(ends[0]);
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (WIFEXITED(status)) outcome.status = WEXITSTATUS(status);
  }
  ::close(ends[0]);
  return outcome;
}

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
  fs::path aside = fs::absolute(file);
  aside.replace_extension(".part.mp4");
  const Outcome outcome = run_program(ffmpeg_arguments(pattern, frame_rate, aside));
  std::error_code error;
  if (outcome.status == 0) fs::rename(aside, file, error);
  if (outcome.status == 0 && !error) return;
  const std::string reason = error ? error.message() : last_lines(outcome.errors, 4);
  fs::remove(aside, error);
  throw RunError(fmt::format("{} was not made from {}: ffmpeg failed:\n{}", file.string(), pattern.string(), reason));
}

}  // namespace flowskin::tools
