#include "tools/experiments/flow_table.h"

#include <fmt/format.h>

#include "tools/experiments/test_flows.h"
#include "tracking/velocity/velocity_method.h"

namespace flowskin::tools {
namespace {

/// Two digits, and nothing finer than what the tests ask for.
std::string shortly(double error) {
  if (error < 1e-6) return "< 1e-6";
  return error < 0.001 ? fmt::format("{:.0e}", error) : fmt::format("{:.2g}", error);
}

std::string table_for(const FlowBody& body, double radius) {
  std::string text = fmt::format("{} of {} particles, effective radius {} spacings:\n\n| method |", body.name,
                                 body.particles.size(), radius);
  std::string rule = "|---|";
  for (const TestFlow& flow : test_flows()) {
    text += fmt::format(" {} |", flow.name);
    rule += "---|";
  }
  text += " path error |\n" + rule + "---|\n";
  for (const auto& method : tracking::velocity_methods()) {
    text += fmt::format("| {} |", method.name);
    for (const TestFlow& flow : test_flows()) {
      const FlowErrors errors = velocity_errors(method.name, body, radius, flow);
      text += fmt::format(" {} ({}) |", shortly(errors.relative_rms), shortly(errors.median));
    }
    text += fmt::format(" {} |\n", shortly(path_error(method.name, body, radius, test_flow("shear"))));
  }
  return text;
}

}  // namespace

std::string flow_table() {
  std::string text =
      "Velocity error over the surface by RMS speed: RMS (median). Path error: mean distance in spacings after unit "
      "shear.\n\n";
  for (const FlowBody& body : {test_ball(), test_block()}) {
    for (const double radius : {2.0, 3.0}) text += table_for(body, radius) + "\n";
  }
  return text;
}

}  // namespace flowskin::tools
