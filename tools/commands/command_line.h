// The command line of the program.
#pragma once

namespace flowskin::tools {

/// Parses the command line and runs the subcommand; prints errors. Exit status as DESIGN.md says: 0, 1 or 2; 128 + the
/// signal where it was interrupted.
int run_program(int argc, const char* const* argv);

}  // namespace flowskin::tools
