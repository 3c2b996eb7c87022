// Errors that end a program, and what its exit status is then.
#pragma once

#include <stdexcept>

namespace flowskin {

/// A file that is read or a command line is wrong; the message says which file, which place in it, and what was
/// expected. Exit status 2.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The run failed (disk full, blow-up, ...); the message says what was kept and how to go on. Exit status 1.
struct RunError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace flowskin
