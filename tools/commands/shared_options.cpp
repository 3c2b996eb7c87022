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

}  // namespace flowskin::tools
