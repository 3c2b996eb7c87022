// The subcommands of the program. Each returns the exit status or throws.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/experiments/paper_run.h"
#include "tools/pipeline/run_options.h"

namespace flowskin::tools {

/// Parses the command line and runs the subcommand; prints errors. Exit status as DESIGN.md says: 0, 1 or 2.
int run_program(int argc, const char* const* argv);

/// Overrides of `flowskin render`; unset values are those of the run's scene.
struct RenderOptions {
  std::filesystem::path directory;
  int width = 0, height = 0, samples = 0;  ///< 0: as in the scene
  std::vector<double> camera, look_at;     ///< 3 numbers each (m), or empty
  double vertical_fov = 0;                 ///< degrees; 0: as in the scene
  std::string style;                       ///< empty: as in the scene
  std::string what = "both";               ///< surface, particles, both
  int threads = 0;
  bool video = true, quiet = false;
};

int render_command(const RenderOptions& options);
int info_command(const std::vector<std::filesystem::path>& files);
/// `table`: their errors on the test flows as well.
int methods_command(bool table);
int paper_command(const PaperOptions& options);
/// `what`: "defaults" or "keys" (as a Markdown table).
int scene_command(const std::string& what);

}  // namespace flowskin::tools
