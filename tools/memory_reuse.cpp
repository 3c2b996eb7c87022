#include "tools/memory_reuse.h"

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace flowskin::tools {

void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int never = 2'000'000'000;  // bytes
  ::mallopt(M_MMAP_MAX, 0);
  ::mallopt(M_TRIM_THRESHOLD, never);
#endif
}

}  // namespace flowskin::tools
