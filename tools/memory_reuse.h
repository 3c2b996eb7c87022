// Freed memory stays with the program.
#pragma once

namespace flowskin::tools {

/// Large buffers are made anew in each step. By default the C library hands each back to the system, which clears its
/// pages when it gives them out again: a tenth of the time at a million particles. From now on they are kept. Does
/// nothing where the C library is not GNU's.
void keep_freed_memory();

}  // namespace flowskin::tools
