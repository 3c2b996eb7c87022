// summary.md: each claim of the paper beside what was measured.
#pragma once

#include <string>
#include <vector>

#include "tools/experiments/experiment.h"

namespace flowskin::tools {

/// What the head of the summary says about the run.
struct SummaryHead {
  std::string version, machine, command;
  int threads = 0;
  double seconds = 0;
  bool quick = false;
  std::vector<std::string> methods;
  std::string best;
};

/// The whole file, Markdown; pictures and CSV files are named relative to its folder.
std::string summary_text(const SummaryHead& head, const std::vector<ExperimentReport>& reports);

/// All claims of all experiments, for verdicts.csv.
ResultTable verdict_table(const std::vector<ExperimentReport>& reports);

}  // namespace flowskin::tools
