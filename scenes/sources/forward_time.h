// The rule that all sources share: time only goes forward.
#pragma once

#include <fmt/format.h>

#include <stdexcept>

namespace flowskin::scenes {

/// @throws std::invalid_argument where `time` is before `now` or no time at all.
inline void require_forward(double now, double time) {
  if (!(time >= now) || time > 1e9) {
    throw std::invalid_argument(fmt::format(
        "a particle source at {} s cannot go to {} s: time only goes forward, and at most to 1e9 s", now, time));
  }
}

}  // namespace flowskin::scenes
