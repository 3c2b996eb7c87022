// The subcommands of the program. Each returns the exit status or throws.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "tools/experiments/paper_run.h"
#include "tools/pipeline/run_options.h"
#include "tools/validation/validation_run.h"

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

/// What `flowskin track` is told; lengths in metres. Unset values are estimated or have defaults.
struct TrackOptions {
  std::vector<std::filesystem::path> particles;  ///< files, patterns, a folder, or one .pvd
  std::optional<double> spacing, radius, edge_length, tile_size;
  std::optional<double> frame_rate, time_step;  ///< files a second, s between files
  bool no_ids = false;
  std::string texture, mapping;  ///< empty: the scene file's defaults
  std::string up = "y";          ///< or z
  RunOptions run;                ///< without scene_file
};

int track_command(const TrackOptions& options);
/// The part of the scene that says which files are played, and how.
scenes::RecordedSpec recorded_spec(const TrackOptions& options);

int render_command(const RenderOptions& options);
int info_command(const std::vector<std::filesystem::path>& files);
/// `table`: their errors on the test flows as well.
int methods_command(bool table);
int paper_command(const PaperOptions& options);
/// 1 where some figure lies outside its limits.
int validate_command(const ValidateOptions& options);
/// `what`: "defaults" or "keys" (as a Markdown table).
int scene_command(const std::string& what);

}  // namespace flowskin::tools
