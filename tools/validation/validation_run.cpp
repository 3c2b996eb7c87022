#include "tools/validation/validation_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "common/errors.h"
#include "common/thread_count.h"
#include "scenes/io/atomic_file.h"
#include "sph/solver.h"
#include "tools/report/messages.h"
#include "tools/report/run_log.h"
#include "tools/report/stage_clock.h"

namespace flowskin::tools {
namespace {

namespace fs = std::filesystem;

std::vector<ValidationCase> chosen_cases(const ValidateOptions& options) {
  std::vector<ValidationCase> chosen;
  for (const std::string& name : options.names) chosen.push_back(validation_case(name));
  if (options.names.empty()) chosen = validation_cases();
  if (options.quick) std::erase_if(chosen, [](const ValidationCase& one) { return !one.quick; });
  return chosen;
}

void prepare_folder(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error))
    throw InputError(fmt::format("{} is a file; --out needs a folder", folder.string()));
  fs::create_directories(folder, error);
  if (error) throw RunError(fmt::format("cannot make the folder {}: {}", folder.string(), error.message()));
}

std::string report_text(const std::vector<ValidationCase>& cases, const std::vector<ValidationOutcome>& outcomes,
                        double resolution) {
  std::string text = fmt::format("# Validation of the fluid\n\n{}; {}\n\n", version_text(), machine_text());
  if (resolution != 1) text += fmt::format("Resolution times {}; the tolerances are meant for 1.\n\n", resolution);
  text += outcome_table(outcomes).markdown();
  for (std::size_t k = 0; k < outcomes.size(); ++k) {
    const ValidationOutcome& outcome = outcomes[k];
    text += fmt::format("\n## {}\n\n{}\n", outcome.name, cases[k].title);
    if (!outcome.failure.empty()) text += fmt::format("\nIt could not be computed: {}\n", outcome.failure);
    if (!outcome.result.plots.plots.empty()) text += fmt::format("\n![{0}]({0}.svg)\n", outcome.name);
    if (!outcome.result.data.rows.empty()) text += fmt::format("\nNumbers: [{0}.csv]({0}.csv)\n", outcome.name);
  }
  return text;
}

std::string verdict(const ValidationFigure& figure) {
  if (!figure.holds()) return "FAILED";
  return figure.is_information() ? "information" : "holds";
}

}  // namespace

bool ValidationOutcome::holds() const {
  const auto& figures = result.figures;
  return failure.empty() && !figures.empty() &&
         std::all_of(figures.begin(), figures.end(), [](const ValidationFigure& f) { return f.holds(); });
}

ValidationOutcome run_case(const ValidationCase& one, double resolution) {
  ValidationOutcome outcome;
  outcome.name = one.name;
  const double begin = wall_seconds();
  try {
    outcome.result = one.run(resolution);
  } catch (const sph::BlowUpError& error) {
    outcome.failure = error.what();
  } catch (const sph::SettingsError& error) {
    outcome.failure = error.what();
  }
  outcome.seconds = wall_seconds() - begin;
  return outcome;
}

ResultTable outcome_table(const std::vector<ValidationOutcome>& outcomes) {
  ResultTable table;
  table.columns = {"case", "figure", "tolerance", "measured", "verdict", "seconds"};
  const auto without_commas = [](std::string text) {
    std::replace(text.begin(), text.end(), ',', ';');
    return text;
  };
  for (const ValidationOutcome& outcome : outcomes) {
    const double seconds = 0.01 * std::round(100 * outcome.seconds);
    if (!outcome.failure.empty())
      table.add({outcome.name, without_commas(outcome.failure), std::string(), std::string(), std::string("FAILED"),
                 seconds});
    for (const ValidationFigure& figure : outcome.result.figures) {
      table.add(
          {outcome.name, without_commas(figure.what), figure.tolerance(), figure.measured, verdict(figure), seconds});
    }
  }
  return table;
}

std::string outcome_text(const std::vector<ValidationOutcome>& outcomes) {
  const ResultTable table = outcome_table(outcomes);
  std::vector<std::vector<std::string>> lines{table.columns};
  for (const auto& row : table.rows) {
    lines.emplace_back();
    for (const Cell& cell : row) {
      const auto* number = std::get_if<double>(&cell);
      lines.back().push_back(number ? short_number(*number) : std::get<std::string>(cell));
    }
  }
  std::vector<std::size_t> widths(table.columns.size(), 0);
  for (const auto& line : lines) {
    for (std::size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], line[c].size());
  }
  std::string text;
  for (const auto& line : lines) {
    for (std::size_t c = 0; c < line.size(); ++c) {
      text += c + 1 == line.size() ? fmt::format("{:>{}}", line[c], widths[c])
                                   : fmt::format("{:<{}}  ", line[c], widths[c]);
    }
    text += '\n';
  }
  return text;
}

void write_outcome(const ValidationOutcome& outcome, const fs::path& folder) {
  if (!outcome.result.data.rows.empty())
    scenes::write_file(folder / (outcome.name + ".csv"), outcome.result.data.csv());
  if (!outcome.result.plots.plots.empty()) write_plots(outcome.result.plots, folder / outcome.name);
}

bool run_validation(const ValidateOptions& options) {
  const std::vector<ValidationCase> cases = chosen_cases(options);
  if (options.list) {
    for (const ValidationCase& one : cases)
      put(fmt::format("{:<20} {:<6} {}\n", one.name, one.quick ? "quick" : "long", one.title));
    return true;
  }
  use_threads(options.threads);
  prepare_folder(options.out);
  std::vector<ValidationOutcome> outcomes;
  bool all_hold = true;
  for (const ValidationCase& one : cases) {
    outcomes.push_back(run_case(one, options.resolution));
    const ValidationOutcome& outcome = outcomes.back();
    all_hold = all_hold && outcome.holds();
    write_outcome(outcome, options.out);
    if (!options.quiet) {
      put(fmt::format("{:<20} {} ({:.1f} s)\n", one.name, outcome.holds() ? "holds" : "FAILED", outcome.seconds));
      std::fflush(stdout);
    }
  }
  scenes::write_file(options.out / "validation.csv", outcome_table(outcomes).csv());
  scenes::write_file(options.out / "validation.md", report_text(cases, outcomes, options.resolution));
  put(fmt::format("\n{}\n{}; plots and numbers are in {}\n", outcome_text(outcomes),
                  all_hold ? "all figures hold" : "some figures FAILED", options.out.string()));
  return all_hold;
}

}  // namespace flowskin::tools
