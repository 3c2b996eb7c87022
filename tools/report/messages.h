// What the program says: messages, which may be lost, and results, which may not.
#pragma once

#include <string>

#include "common/printable_text.h"

namespace flowskin::tools {

/// Call first of all: descriptors 0, 1 and 2 that are closed are given to /dev/null, so that no data file gets their
/// numbers, and a pipe that nobody reads any more is an error, not a signal that kills.
void secure_standard_streams();

/// Text for whoever watches, to standard error. Where that cannot be written (a closed terminal, a full disk), it is
/// lost: the work does not depend on it.
void say(const std::string& text);
/// The same with an end of line; control characters are made visible.
inline void say_line(const std::string& line) { say(printable(line) + "\n"); }

/// Text that was asked for, to standard output; control characters are made visible.
void put(const std::string& text);
/// Why some of it did not get there; empty: all did. Waits until all is written.
std::string output_failure();

}  // namespace flowskin::tools
