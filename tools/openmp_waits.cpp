#include "tools/openmp_waits.h"

#include <unistd.h>

#include <cstdlib>

namespace flowskin::tools {

void restart_with_short_waits(char** arguments) {
  // About ten microseconds: what waking a thread takes.
  constexpr const char* spins = "1000";
  if (std::getenv("GOMP_SPINCOUNT") != nullptr || std::getenv("OMP_WAIT_POLICY") != nullptr) return;
  if (::setenv("GOMP_SPINCOUNT", spins, 1) == 0) ::execv("/proc/self/exe", arguments);
}

}  // namespace flowskin::tools
