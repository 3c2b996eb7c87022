#include "tools/commands/shared_options.h"

#include "tools/pipeline/tracker_bridge.h"
#include "tracking/velocity/velocity_method.h"

namespace flowskin::tools {

namespace {
constexpr int kMostThreads = 1024;
}  // namespace

Option threads_option(int& threads, const std::string& help) {
  return {"--threads", &threads, help, {.range = {{1, kMostThreads}}}};
}

Option velocity_option(std::optional<std::string>& velocity, const std::string& standard) {
  std::vector<std::string> names{scenes::automatic_velocity};
  for (const auto& method : tracking::velocity_methods()) names.push_back(method.name);
  return {
      "--velocity", &velocity, "Velocity method (default: " + standard + "); see `flowskin methods`", {.words = names}};
}

Option overwrite_option(RunOptions& run) {
  return {"--overwrite",
          &run.overwrite,
          "Replace the run in the run directory: the files that FlowSkin wrote, no others. Not needed in the default "
          "directory after a finished run of the same scene whose files nobody changed; see docs/files.md",
          {.excludes = "--resume"}};
}

Option hangup_option(RunOptions& run) {
  return {"--stop-on-hangup", &run.stop_on_hangup,
          "Stop when the terminal is closed (SIGHUP), as on SIGTERM; otherwise the run saves a checkpoint and goes on"};
}

}  // namespace flowskin::tools
