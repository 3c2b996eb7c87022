// All experiments of the paper, into one folder.
#pragma once

#include <filesystem>
#include <string>

namespace flowskin::tools {

/// What the command line says.
struct PaperOptions {
  std::filesystem::path out = "output/paper";
  std::filesystem::path scenes;  ///< Folder with translation.json and so on; empty: found by itself.
  bool quick = false;            ///< A reduced version of some seconds.
  int threads = 0;               ///< 0: as many as the machine has
  bool quiet = false;
  std::string command_line;
};

/// Runs them and writes tables, pictures, verdicts.csv, log and, last, summary.md.
/// @throws InputError where `out` or the scenes cannot be used; RunError where writing fails.
void run_paper(const PaperOptions& options);

}  // namespace flowskin::tools
