// Errors that end a program, and what its exit status is then.
#pragma once

#include <exception>
#include <stdexcept>
#include <string>

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

/// What an exception says to the user; those of std::filesystem as "path: reason".
std::string plain_message(const std::exception& error);

}  // namespace flowskin
