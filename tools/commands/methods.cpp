// flowskin methods: the velocity methods and when to use which.
#include <fmt/format.h>

#include <memory>

#include "tools/commands/command.h"
#include "tools/experiments/flow_table.h"
#include "tools/experiments/sloshing_block.h"
#include "tools/report/messages.h"
#include "tracking/velocity/velocity_method.h"

namespace flowskin::tools {

Command methods_command() {
  struct Chosen {
    bool table = false, flows = false;
  };
  const auto chosen = std::make_shared<Chosen>();
  return {"methods",
          "List the velocity methods and when to use which",
          {{"--table", &chosen->table, "The errors of their velocities in flows that are known everywhere (Markdown)"},
           {"--flows", &chosen->flows,
            "How far the texture is off its material when particles of a known flow are written as files and tracked "
            "(Markdown; half an hour)"}},
          [chosen](const std::string&) {
            if (chosen->table) put(flow_table());
            if (chosen->flows) put_sloshing_table({}, put);
            if (chosen->table || chosen->flows) return 0;
            for (const auto& method : tracking::velocity_methods())
              put(fmt::format("{:<18} {}\n", method.name, method.summary));
            return 0;
          }};
}

}  // namespace flowskin::tools
