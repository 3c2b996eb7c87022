// flowskin methods: the velocity methods and when to use which.
#include <fmt/format.h>

#include <memory>

#include "tools/commands/command.h"
#include "tools/experiments/flow_table.h"
#include "tools/report/messages.h"
#include "tracking/velocity/velocity_method.h"

namespace flowskin::tools {

Command methods_command() {
  const auto table = std::make_shared<bool>(false);
  return {"methods",
          "List the velocity methods and when to use which",
          {{"--table", table.get(), "Their errors on flows that are known everywhere (Markdown)"}},
          [table](const std::string&) {
            if (*table) {
              put(flow_table());
              return 0;
            }
            for (const auto& method : tracking::velocity_methods())
              put(fmt::format("{:<18} {}\n", method.name, method.summary));
            return 0;
          }};
}

}  // namespace flowskin::tools
