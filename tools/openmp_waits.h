// How threads without work wait for the next loop.
#pragma once

namespace flowskin::tools {

/// Threads of GCC's OpenMP that have come to the end of a loop spin for the others, by default for milliseconds: where
/// other programs want the processors they take from them, and from the threads that they wait for, more than they give
/// (two threads are slower than one there). The length of the spin is read from GOMP_SPINCOUNT before main() begins. So
/// this starts the program once more, in the same process, with a short one, unless the user has set it or
/// OMP_WAIT_POLICY. Where that fails the program just goes on.
void restart_with_short_waits(char** arguments);

}  // namespace flowskin::tools
