// The list of all subcommands.
#include "tools/commands/command.h"

namespace flowskin::tools {

// Each is defined in the file of its name in tools/commands/.
Command run_command();
Command track_command();
Command render_command();
Command paper_command();
Command validate_command();
Command info_command();
Command methods_command();
Command scene_command();

std::vector<Command> commands() {
  return {run_command(),      track_command(), render_command(),  paper_command(),
          validate_command(), info_command(),  methods_command(), scene_command()};
}

}  // namespace flowskin::tools
