#include "tools/experiments/summary.h"

#include <fmt/format.h>

namespace flowskin::tools {
namespace {

std::string head_text(const SummaryHead& head) {
  std::string methods;
  for (const std::string& method : head.methods) methods += fmt::format("{}`{}`", methods.empty() ? "" : ", ", method);
  return fmt::format(
      "# The paper's experiments, repeated\n\n"
      "Fujisawa, Mandachi, Miura: Calculation of Velocity on an Implicit Surface by Curvature Invariance, 2013 "
      "[FMM13].\n"
      "Lengths are in effective radii (sigma) where nothing else is said. The measures and how to read them: "
      "docs/paper.md.\n\n"
      "| | |\n|---|---|\n| version | {} |\n| machine | {} |\n| command | `{}` |\n| threads | {} |\n| time | {:.0f} s "
      "|\n"
      "| methods | {} |\n| shown as the best method | `{}` |\n\n{}",
      head.version, head.machine, head.command, head.threads, head.seconds, methods, head.best,
      head.quick ? "**Reduced version (--quick): fewer steps, revolutions and parameters; its verdicts are those of a "
                   "trial.**\n\n"
                 : "");
}

std::string overview(const std::vector<ExperimentReport>& reports) {
  std::string text = "## Verdicts\n\n| Source | Claim | Verdict |\n|---|---|---|\n";
  for (const ExperimentReport& report : reports)
    for (const Claim& claim : report.claims)
      text += fmt::format("| {} | {} | **{}** |\n", claim.source, claim.claim, verdict_name(claim.verdict));
  return text + "\n";
}

std::string section(const ExperimentReport& report) {
  std::string text = fmt::format("## {}\n\n{}\n\n", report.title, report.setup);
  text += "| Source | Claim | Measured | Verdict |\n|---|---|---|---|\n";
  for (const Claim& claim : report.claims)
    text += fmt::format("| {} | {} | {} | **{}**{}{} |\n", claim.source, claim.claim, claim.measured,
                        verdict_name(claim.verdict), claim.reason.empty() ? "" : ". ", claim.reason);
  text += "\n";
  for (const auto& [caption, file] : report.pictures)
    text += fmt::format("{}:\n\n![{}]({})\n\n", caption, caption, file);
  for (const auto& [caption, table] : report.tables) text += fmt::format("{}:\n\n{}\n", caption, table.markdown());
  text += "Numbers: ";
  for (const std::string& file : report.files) text += fmt::format("[{}]({}) ", file, file);
  return text + fmt::format("({:.1f} s)\n\n", report.seconds);
}

// CSV cells hold no commas or quotes.
std::string plain(std::string text) {
  for (char& letter : text)
    if (letter == ',') letter = ';';
  return text;
}

}  // namespace

std::string summary_text(const SummaryHead& head, const std::vector<ExperimentReport>& reports) {
  std::string text = head_text(head) + overview(reports);
  for (const ExperimentReport& report : reports) text += section(report);
  return text;
}

ResultTable verdict_table(const std::vector<ExperimentReport>& reports) {
  ResultTable table;
  table.columns = {"experiment", "source", "claim", "measured", "verdict"};
  for (const ExperimentReport& report : reports)
    for (const Claim& claim : report.claims)
      table.add({plain(report.title), plain(claim.source), plain(claim.claim), plain(claim.measured),
                 verdict_name(claim.verdict)});
  return table;
}

}  // namespace flowskin::tools
