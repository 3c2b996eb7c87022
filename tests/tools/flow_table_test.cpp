// The velocity methods on flows that are known everywhere: the bounds that the project promises.
#include "tools/experiments/flow_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "tools/experiments/test_flows.h"
#include "tracking/velocity/velocity_method.h"

namespace flowskin::tools::flow_table_test {
namespace {

// Relative RMS velocity error at an effective radius of 2 spacings; at 3 spacings twice that.
TEST(FlowTable, ErrorsKeepTheirBounds) {
  const std::map<std::string, std::map<std::string, double>> bounds = {{"rigid-global",
                                                                        {{"translation", 1e-6},
                                                                         {"rotation", 1e-6},
                                                                         {"shear", 0.25},
                                                                         {"stretch", 0.35},
                                                                         {"vortex", 0.30},
                                                                         {"rotation + noise", 0.12}}},
                                                                       {"affine",
                                                                        {{"translation", 1e-6},
                                                                         {"rotation", 1e-6},
                                                                         {"shear", 0.07},
                                                                         {"stretch", 0.10},
                                                                         {"vortex", 0.20},
                                                                         {"rotation + noise", 0.12}}},
                                                                       {"hybrid",
                                                                        {{"translation", 1e-6},
                                                                         {"rotation", 1e-6},
                                                                         {"shear", 0.005},
                                                                         {"stretch", 0.005},
                                                                         {"vortex", 0.035},
                                                                         {"rotation + noise", 0.12}}}};
  for (const auto& [method, flows] : bounds) {
    for (const auto& [name, bound] : flows) {
      EXPECT_LT(velocity_errors(method, test_ball(), 2, test_flow(name)).relative_rms, bound) << method << ", " << name;
      EXPECT_LT(velocity_errors(method, test_ball(), 3, test_flow(name)).relative_rms, 2 * bound)
          << method << ", " << name;
    }
  }
}

TEST(FlowTable, CurvatureNeverBlowsUp) {
  for (const FlowBody& body : {test_ball(), test_block()}) {
    for (const double radius : {2.0, 3.0}) {
      for (const TestFlow& flow : test_flows()) {
        EXPECT_LT(velocity_errors("curvature", body, radius, flow).relative_rms, flow.name == "rotation" ? 0.45 : 0.8)
            << body.name << ", " << radius << ", " << flow.name;
      }
    }
  }
}

// On no flow may the hybrid be more than a tenth worse than the better of the two that it is made of.
TEST(FlowTable, HybridIsNeverMuchWorseThanItsParts) {
  for (const FlowBody& body : {test_ball(), test_block()}) {
    for (const double radius : {2.0, 2.5, 3.0}) {
      for (const TestFlow& flow : test_flows()) {
        const double simulation = velocity_errors("simulation", body, radius, flow).relative_rms;
        const double affine = velocity_errors("affine", body, radius, flow).relative_rms;
        EXPECT_LT(velocity_errors("hybrid", body, radius, flow).relative_rms, 1.1 * std::min(simulation, affine) + 1e-9)
            << body.name << ", " << radius << ", " << flow.name;
      }
    }
  }
}

TEST(FlowTable, PathErrorsAfterUnitShear) {
  const auto after_shear = [](const char* method) { return path_error(method, test_ball(), 2, test_flow("shear")); };
  EXPECT_LT(after_shear("rigid-global"), 0.55);
  EXPECT_LT(after_shear("affine"), 0.22);
  EXPECT_LT(after_shear("simulation"), 0.08);
  EXPECT_LT(after_shear("hybrid"), 0.08);
  EXPECT_GT(after_shear("normal"), 1.0);  // the measure sees what is wrong
}

// The particles themselves, and a body that is where it should be: a few hundred, one metre across.
TEST(FlowTable, BodiesAreAsDescribed) {
  for (const FlowBody& body : {test_ball(), test_block()}) {
    EXPECT_GT(body.particles.size(), 300u);
    EXPECT_LT(body.particles.size(), 400u);
    double reach = 0;
    for (const Vec3& x : body.particles) reach = std::max(reach, x.cwiseAbs().maxCoeff());
    EXPECT_NEAR(reach, 0.5, 0.1);
  }
}

}  // namespace
}  // namespace flowskin::tools::flow_table_test
