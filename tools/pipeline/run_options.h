// What the command line may say about a run.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace flowskin::tools {

struct RunOptions {
  std::filesystem::path scene_file;
  std::filesystem::path out;            ///< empty: output/<name of the scene file>
  bool out_is_default = false;          ///< nobody has chosen it
  std::optional<int> frames;            ///< instead of the scene's
  std::optional<std::string> velocity;  ///< instead of the scene's
  std::string compare;                  ///< velocity methods to compare, comma separated, or "all"; empty: none
  int threads = 0;                      ///< 0: as many as the machine has
  bool pictures = true;
  bool video = true;
  bool quiet = false;
  bool resume = false;          ///< go on from the last checkpoint in the run directory
  bool overwrite = false;       ///< replace the run in the run directory
  bool stop_on_hangup = false;  ///< SIGHUP ends the run as SIGTERM does
  std::string command_line;     ///< as typed, for the log
};

}  // namespace flowskin::tools
