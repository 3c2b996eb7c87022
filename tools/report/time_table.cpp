#include "tools/report/time_table.h"

#include <fmt/format.h>

namespace flowskin::tools {

namespace {

constexpr double kWorthALine = 0.005;  // s

std::string line(const std::string& name, double seconds, double simulated, double all) {
  std::string text = fmt::format("{:<20}{:>10.2f} s", name, seconds);
  if (simulated > 0) text += fmt::format("{:>12.3f} s", seconds / simulated);
  if (all > 0) text += fmt::format("{:>7.1f} %", 100 * seconds / all);
  return text;
}

}  // namespace

std::vector<std::string> time_table(const std::vector<StageTime>& stages, double simulated, double all) {
  std::vector<std::string> lines;
  lines.push_back(fmt::format("{:<20}{:>12}{}{:>9}", "computing time", "in all",
                              simulated > 0 ? fmt::format("{:>14}", "per second") : std::string(), "share"));
  double known = 0;
  for (const StageTime& stage : stages) {
    known += stage.seconds;
    lines.push_back(line(stage.name, stage.seconds, simulated, all));
    double of_parts = 0;
    for (const auto& [name, seconds] : stage.parts) {
      of_parts += seconds;
      lines.push_back(line("  " + name, seconds, simulated, all));
    }
    if (!stage.parts.empty() && stage.seconds - of_parts >= kWorthALine)
      lines.push_back(line("  other", stage.seconds - of_parts, simulated, all));
  }
  if (all - known >= kWorthALine) lines.push_back(line("other", all - known, simulated, all));
  lines.push_back(line("in all", all, simulated, all));
  if (simulated > 0)
    lines.push_back(
        fmt::format("per second: of the {:.4g} s that were simulated; all are seconds of wall time", simulated));
  return lines;
}

}  // namespace flowskin::tools
