// Where the computing time of a run went.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace flowskin::tools {

/// Seconds of one stage, and of the parts of it that are measured by themselves.
struct StageTime {
  std::string name;
  double seconds = 0;
  std::vector<std::pair<std::string, double>> parts{};
};

/// One line per stage and part: seconds in all, for one simulated second, and the share of the whole. What the parts
/// leave over is called "other".
/// @param simulated seconds of the scene; where it is 0 that column is left out
/// @param all wall time of the run, the rest of which is "other" as well
std::vector<std::string> time_table(const std::vector<StageTime>& stages, double simulated, double all);

}  // namespace flowskin::tools
