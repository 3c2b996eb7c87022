// Another program that is run and waited for.
#pragma once

#include <string>
#include <vector>

namespace flowskin::tools {

/// What a child process left behind.
struct ChildOutcome {
  int status = -1;     ///< Exit status; -1 where it was killed or never ran.
  std::string errors;  ///< Its standard error.
};

/// Runs a program found on the path, without a shell: arguments may contain anything. It is killed where this program
/// ends first, however that ends. @throws RunError
ChildOutcome run_child(const std::vector<std::string>& arguments);

/// Kills the one that is running. Safe in a signal handler.
void kill_child() noexcept;

}  // namespace flowskin::tools
