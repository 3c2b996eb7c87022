// flowskin paper: the experiments of the paper, repeated.
#include "tools/experiments/paper_run.h"

#include <memory>

#include "tools/commands/shared_options.h"

namespace flowskin::tools {

Command paper_command() {
  const auto chosen = std::make_shared<PaperOptions>();
  const std::vector<Option> options{
      {"--out", &chosen->out, "Folder of the results", {.shows_default = true}},
      {"--scenes", &chosen->scenes, "Folder of the experiments' scenes (default: scenes/paper)"},
      {"--quick", &chosen->quick, "A reduced version of some seconds"},
      threads_option(chosen->threads, "Threads (default: all); results but times do not depend on it"),
      {"--quiet", &chosen->quiet, "Warnings and errors only"},
  };
  return {"paper", "Repeat the paper's experiments: tables, plots, pictures, verdicts", options,
          [chosen](const std::string& command_line) {
            chosen->command_line = command_line;
            run_paper(*chosen);
            return 0;
          }};
}

}  // namespace flowskin::tools
