// flowskin paper: the experiments of the paper, repeated.
#include "tools/commands/commands.h"
#include "tools/experiments/paper_run.h"

namespace flowskin::tools {

int paper_command(const PaperOptions& options) {
  run_paper(options);
  return 0;
}

}  // namespace flowskin::tools
