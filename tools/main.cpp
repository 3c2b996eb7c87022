#include "tools/commands/command_line.h"
#include "tools/memory_reuse.h"
#include "tools/openmp_waits.h"

int main(int argc, char** argv) {
  flowskin::tools::restart_with_short_waits(argv);
  flowskin::tools::keep_freed_memory();
  return flowskin::tools::run_program(argc, argv);
}
