#include "tools/report/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "tools/report/messages.h"
#include "tools/report/stage_clock.h"

namespace flowskin::tools {

namespace {
constexpr double kTerminalInterval = 0.2;  // s between two drawings of the line
constexpr double kPlainInterval = 10;      // s between two plain lines
}  // namespace

std::string format_duration(double seconds) {
  const long whole = std::lround(std::max(0.0, seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

Progress::Progress(std::string unit, int total, Mode mode, int before)
    : unit_(std::move(unit)),
      total_(total),
      before_(before),
      quiet_(mode == Mode::quiet),
      terminal_(isatty(STDERR_FILENO) != 0),
      start_(wall_seconds()) {}

Progress::~Progress() { finish(); }

void Progress::update(int done, const std::string& details) {
  if (quiet_) return;
  const double now = wall_seconds();
  const bool last = done >= total_;
  if (!last && now - last_shown_ < (terminal_ ? kTerminalInterval : kPlainInterval)) return;
  last_shown_ = now;
  const double elapsed = now - start_;
  const std::string left = last ? fmt::format("took {}", format_duration(elapsed))
                           : done > before_
                               ? fmt::format("{} left", format_duration(elapsed * (total_ - done) / (done - before_)))
                               : std::string("starting");
  std::string line = fmt::format("{} {}/{}  {}  {}", unit_, done, total_, details, left);
  if (!terminal_) {
    say_line(line);
    return;
  }
  const std::size_t length = line.size();
  line.append(last_length_ > length ? last_length_ - length : 0, ' ');
  last_length_ = length;
  say("\r" + line);
}

void Progress::finish() {
  if (!quiet_ && terminal_ && last_length_ > 0) say("\n");
  last_length_ = 0;
}

}  // namespace flowskin::tools
