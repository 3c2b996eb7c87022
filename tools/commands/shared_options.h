// Options that several subcommands have.
#pragma once

#include <string>

#include "tools/commands/command.h"
#include "tools/pipeline/run_options.h"

namespace flowskin::tools {

Option threads_option(int& threads, const std::string& help = "Threads (default: all); results do not depend on it");
/// @param standard what is taken where it is not given, in words
Option velocity_option(std::optional<std::string>& velocity, const std::string& standard);

/// To stand behind --resume.
Option overwrite_option(RunOptions& run);
Option hangup_option(RunOptions& run);

/// What --no-pictures and --no-video say of a run.
struct PictureFlags {
  bool no_pictures = false, no_video = false;

  Option pictures_option() { return {"--no-pictures", &no_pictures, "Neither pictures nor videos"}; }
  Option video_option() { return {"--no-video", &no_video, "Pictures but no videos"}; }
  void apply(RunOptions& run) const {
    run.pictures = !no_pictures;
    run.video = !no_video;
  }
};

}  // namespace flowskin::tools
