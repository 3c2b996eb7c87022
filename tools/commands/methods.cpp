// flowskin methods: the velocity methods and when to use which.
#include <fmt/format.h>

#include "tools/commands/commands.h"
#include "tools/experiments/flow_table.h"
#include "tracking/velocity/velocity_method.h"

namespace flowskin::tools {

int methods_command(bool table) {
  if (table) {
    fmt::print("{}", flow_table());
    return 0;
  }
  for (const auto& method : tracking::velocity_methods()) fmt::print("{:<18} {}\n", method.name, method.summary);
  return 0;
}

}  // namespace flowskin::tools
