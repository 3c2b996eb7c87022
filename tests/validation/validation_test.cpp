// The quick validations as tests; `tools/test --validation` runs all of them.
#include <gtest/gtest.h>

#include <cmath>

#include "common/errors.h"
#include "sph/solver.h"
#include "tools/validation/validation_run.h"

namespace flowskin::tools {
namespace {

std::vector<std::string> quick_names() {
  std::vector<std::string> names;
  for (const ValidationCase& one : validation_cases()) {
    if (one.quick) names.push_back(one.name);
  }
  return names;
}

class QuickValidation : public testing::TestWithParam<std::string> {};

TEST_P(QuickValidation, AllFiguresHold) {
  const ValidationOutcome outcome = run_case(validation_case(GetParam()), 1);
  EXPECT_TRUE(outcome.holds()) << outcome_text({outcome});
  EXPECT_FALSE(outcome.result.data.rows.empty());
  EXPECT_FALSE(outcome.result.plots.plots.empty());
}

INSTANTIATE_TEST_SUITE_P(All, QuickValidation, testing::ValuesIn(quick_names()),
                         [](const auto& test) { return test.param; });

TEST(Validation, FiguresOutsideTheirLimitsAndNaNFail) {
  EXPECT_TRUE(at_most("a", 0.02, 0.02).holds());
  EXPECT_FALSE(at_most("a", 0.021, 0.02).holds());
  EXPECT_FALSE(at_most("a", std::nan(""), 0.02).holds());
  EXPECT_FALSE(at_least("a", 1, 2).holds());
  EXPECT_TRUE(near_to("a", 0.13, 0.125, 0.01).holds());
  EXPECT_FALSE(near_to("a", 0.14, 0.125, 0.01).holds());
  EXPECT_FALSE(near_to("a", std::nan(""), 0.125, 0.01).holds());
  EXPECT_EQ(near_to("a", 0, 0.125, 0.01).tolerance(), "0.115 to 0.135");
}

TEST(Validation, ACaseThatBlowsUpOrMeasuresNothingFails) {
  const auto outcome_of = [](auto run) { return run_case({"some", "title", true, run}, 1); };
  const ValidationOutcome blown =
      outcome_of([](double) -> ValidationResult { throw sph::BlowUpError("too fast, by far"); });
  EXPECT_FALSE(blown.holds());
  EXPECT_NE(outcome_text({blown}).find("too fast; by far"), std::string::npos);
  EXPECT_FALSE(outcome_of([](double) { return ValidationResult{}; }).holds());
  EXPECT_FALSE(outcome_of([](double) {
                 return ValidationResult{{at_most("x", 1, 2), at_most("y", 3, 2)}, {}, {}};
               }).holds());
  EXPECT_TRUE(outcome_of([](double) { return ValidationResult{{at_most("x", 1, 2)}, {}, {}}; }).holds());
}

TEST(Validation, NamesAreDistinctAndUnknownOnesAreErrors) {
  for (const ValidationCase& one : validation_cases()) EXPECT_EQ(validation_case(one.name).title, one.title);
  try {
    validation_case("conservatoin");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean \"conservation\"?"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace flowskin::tools
