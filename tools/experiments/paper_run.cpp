#include "tools/experiments/paper_run.h"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <vector>

#include "common/errors.h"
#include "common/thread_count.h"
#include "scenes/io/atomic_file.h"
#include "tools/experiments/experiment.h"
#include "tools/experiments/summary.h"
#include "tools/pipeline/interruption.h"
#include "tools/report/run_log.h"
#include "tools/report/stage_clock.h"

namespace flowskin::tools {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSummary = "summary.md";
constexpr const char* kLog = "paper_log.txt";
constexpr const char* kAnyScene = "translation.json";

constexpr struct {
  const char* name;
  ExperimentReport (*run)(const PaperRun&);
} kExperiments[] = {
    {"translation", translation_experiment}, {"circling", circling_experiment}, {"ring", ring_experiment},
    {"springs", springs_experiment},         {"targets", targets_experiment},   {"convergence", convergence_experiment},
    {"timing", timing_experiment},           {"weights", weights_experiment},   {"stairs", stairs_experiment},
};

// The folder of this program; empty where the system does not tell.
fs::path program_folder() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return error ? fs::path() : program.parent_path();
}

// scenes/paper of the folder the user is in, or of the source tree that the program was built in.
fs::path find_scenes(const fs::path& wanted) {
  std::vector<fs::path> places;
  if (!wanted.empty()) {
    places = {wanted};
  } else {
    places = {fs::path("scenes/paper")};
    if (!program_folder().empty()) places.push_back((program_folder() / "../scenes/paper").lexically_normal());
  }
  std::string looked;
  for (const fs::path& place : places) {
    std::error_code error;
    if (fs::is_regular_file(place / kAnyScene, error)) return place;
    looked += (looked.empty() ? "" : ", ") + (place / kAnyScene).string();
  }
  throw InputError(fmt::format(
      "the scenes of the experiments are missing: there is no {}; name their folder with --scenes DIR", looked));
}

// An empty folder: new, or with the files of an earlier run removed.
void prepare(const fs::path& out) {
  try {
    if (fs::exists(out) && !fs::is_directory(out))
      throw InputError(fmt::format("{} is a file; --out needs a folder", out.string()));
    if (fs::exists(out) && !fs::is_empty(out)) {
      if (!fs::exists(out / kSummary) && !fs::exists(out / kLog))
        throw InputError(fmt::format(
            "{} is not empty and holds no earlier experiments; give an empty or new folder to --out", out.string()));
      std::vector<fs::path> old;
      for (const auto& entry : fs::directory_iterator(out)) {
        const fs::path extension = entry.path().extension();
        if (extension == ".csv" || extension == ".svg" || extension == ".png") old.push_back(entry.path());
      }
      for (const fs::path& file : old) fs::remove(file);
      fs::remove(out / kSummary);
    }
    fs::create_directories(out);
  } catch (const fs::filesystem_error& error) {
    throw RunError(fmt::format("cannot prepare the folder {}: {}", out.string(), error.code().message()));
  }
}

}  // namespace

void run_paper(const PaperOptions& options) {
  const double started = wall_seconds();
  use_threads(options.threads);
  PaperRun run;
  run.scenes = find_scenes(options.scenes);
  run.out = options.out;
  run.quick = options.quick;
  run.methods = compared_methods();
  run.best = best_method();
  run.best_in_flow = best_methods_in_flow();
  prepare(run.out);
  catch_interruptions();
  RunLog log(run.out / kLog, options.quiet);
  log.detail(version_text());
  log.detail("command: " + options.command_line);
  log.detail("machine: " + machine_text());
  log.info(fmt::format("scenes: {}; {} thread(s)", run.scenes.string(), omp_get_max_threads()));

  std::vector<ExperimentReport> reports;
  for (const auto& experiment : kExperiments) {
    const double begin = wall_seconds();
    try {
      reports.push_back(experiment.run(run));
    } catch (const RunError& error) {
      throw RunError(fmt::format("experiment {}: {}\nthe tables and pictures made so far are in {}", experiment.name,
                                 error.what(), run.out.string()));
    }
    reports.back().seconds = wall_seconds() - begin;
    log.info(fmt::format("{:>12}: {:6.1f} s", experiment.name, reports.back().seconds));
    for (const Claim& claim : reports.back().claims)
      log.detail(
          fmt::format("  {}: {} | {} | {}", claim.source, claim.claim, claim.measured, verdict_name(claim.verdict)));
  }
  scenes::write_file(run.out / "verdicts.csv", verdict_table(reports).csv());
  const SummaryHead head{version_text(),           machine_text(), options.command_line, omp_get_max_threads(),
                         wall_seconds() - started, options.quick,  run.methods,          run.best};
  scenes::write_file(run.out / kSummary, summary_text(head, reports));
  log.info(fmt::format("{:>12}: {:6.1f} s", "in all", wall_seconds() - started));
  log.info("done: " + (run.out / kSummary).string());
}

}  // namespace flowskin::tools
