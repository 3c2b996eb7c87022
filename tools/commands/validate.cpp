// flowskin validate: the solver against theory and experiment.
#include "tools/commands/commands.h"

namespace flowskin::tools {

int validate_command(const ValidateOptions& options) { return run_validation(options) ? 0 : 1; }

}  // namespace flowskin::tools
