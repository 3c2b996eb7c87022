// What the README shows is what the tests compile.
#include <gtest/gtest.h>

#include "end_to_end/program.h"

namespace flowskin {
namespace {

TEST(Readme, ShowsTheLibraryExampleThatIsCompiled) {
  const std::string readme = end_to_end::bytes(FLOWSKIN_SOURCE_DIR "/README.md");
  const std::string example = end_to_end::bytes(FLOWSKIN_SOURCE_DIR "/tests/examples/library_example.cpp");
  EXPECT_NE(readme.find(example), std::string::npos) << "README.md and tests/examples/library_example.cpp differ";
}

}  // namespace
}  // namespace flowskin
