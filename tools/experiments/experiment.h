// What every experiment is given, and what it reports.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "tools/experiments/result_table.h"
#include "tools/report/plot.h"

namespace flowskin::tools {

enum class Verdict { confirmed, in_part, not_confirmed };
/// "confirmed", "confirmed in part", "not confirmed"
std::string verdict_name(Verdict verdict);
/// All hold: confirmed; none: not confirmed; else in part.
Verdict verdict_of(const std::vector<bool>& holds);

/// A claim of the paper, or a target of this project, beside what was measured.
struct Claim {
  std::string source;    ///< "Fig. 2"; "target" where the claim is not the paper's.
  std::string claim;     ///< In words.
  std::string measured;  ///< Numbers with units.
  Verdict verdict = Verdict::not_confirmed;
  std::string reason;  ///< Why, where the numbers do not speak for themselves.
};

/// One section of summary.md.
struct ExperimentReport {
  std::string title;
  std::string setup;  ///< Scene, settings, what is true: a paragraph of Markdown.
  std::vector<Claim> claims;
  std::vector<std::pair<std::string, ResultTable>> tables;    ///< Caption and numbers.
  std::vector<std::pair<std::string, std::string>> pictures;  ///< Caption and file name.
  std::vector<std::string> files;                             ///< CSV files.
  double seconds = 0;                                         ///< Wall time.
};

/// What all experiments share.
struct PaperRun {
  std::filesystem::path scenes;           ///< Folder of the experiments' scene files.
  std::filesystem::path out;              ///< Folder of the results.
  bool quick = false;                     ///< A reduced version for tests: fewer steps, revolutions and parameters.
  std::vector<std::string> methods;       ///< Velocity methods compared, in the order of the registry.
  std::string best;                       ///< The one shown beside the paper's where only the field is given.
  std::vector<std::string> best_in_flow;  ///< Those shown beside the paper's on the stairs.

  /// With a coarser mesh and small pictures where the run is quick.
  /// @throws InputError where the file is missing or wrong.
  scenes::Scene scene(const std::string& name) const;
  /// A line of a plot; each method has the same style in all plots.
  Series series(const std::string& method, std::vector<double> x, std::vector<double> y) const;
  /// Writes `name`.svg and `name`.png and shows them in the report. @throws RunError
  void write_plot_sheet(const std::string& name, const std::string& caption, const PlotSheet& sheet,
                        ExperimentReport& report) const;
  /// Writes `name`.csv and lists it in the report. @throws RunError
  void write_csv(const std::string& name, const ResultTable& table, ExperimentReport& report) const;
};

/// Methods that the experiments compare: all registered ones but `curvature-belyaev`, which equals `curvature`.
std::vector<std::string> compared_methods();
/// The method that stands for this project beside those of the paper.
std::string best_method();
/// The same in a simulated flow: the best that sees the field alone, and the best that knows the particles' velocities.
std::vector<std::string> best_methods_in_flow();

ExperimentReport translation_experiment(const PaperRun& run);  ///< Fig. 2
ExperimentReport circling_experiment(const PaperRun& run);     ///< Figs. 4, 8, 9
ExperimentReport ring_experiment(const PaperRun& run);         ///< Figs. 6, 7
ExperimentReport springs_experiment(const PaperRun& run);      ///< Sec. 5: variable spring constants.
ExperimentReport targets_experiment(const PaperRun& run);      ///< What this project promises on the ring.
ExperimentReport convergence_experiment(const PaperRun& run);  ///< Step counts and order.
ExperimentReport timing_experiment(const PaperRun& run);       ///< Milliseconds per step.
ExperimentReport weights_experiment(const PaperRun& run);      ///< The weight of the total velocity in `curvature`.
ExperimentReport stairs_experiment(const PaperRun& run);       ///< Figs. 10, 11

}  // namespace flowskin::tools
