// flowskin validate: the solver against theory and experiment.
#include <memory>

#include "tools/commands/shared_options.h"
#include "tools/validation/validation_run.h"

namespace flowskin::tools {

/// Exit status 1 where some figure lies outside its limits.
Command validate_command() {
  const auto chosen = std::make_shared<ValidateOptions>();
  const std::vector<Option> options{
      {"names", &chosen->names, "Cases (default: all); see --list"},
      {"--out", &chosen->out, "Folder of the results", {.shows_default = true}},
      {"--resolution",
       &chosen->resolution,
       "Factor on the particles along each length; the tolerances are meant for 1",
       {.range = {{0.25, 8.0}}, .shows_default = true}},
      threads_option(chosen->threads),
      {"--quick", &chosen->quick, "Without the long cases"},
      {"--list", &chosen->list, "Only say which cases there are"},
      {"--quiet", &chosen->quiet, "The table only"},
  };
  return {"validate", "Check the solver against theory and experiment: table, plots, verdicts (docs/validation.md)",
          options, [chosen](const std::string&) { return run_validation(*chosen) ? 0 : 1; }};
}

}  // namespace flowskin::tools
