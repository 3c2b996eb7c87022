// flowskin run --compare from the built program to the files on disk.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "end_to_end/program.h"

namespace flowskin {
namespace {

namespace fs = std::filesystem;
using end_to_end::run_flowskin;
using end_to_end::Table;

/// The preview with the paper's field, of which theory knows the errors: the wall half a spacing below the ball bends
/// the surface a little where the field knows of it.
std::string preview_without_walls(const fs::path& folder) {
  std::string text = end_to_end::bytes(end_to_end::scene("stairs_preview.json"));
  const auto replace_all = [&text](const std::string& from, const std::string& to) {
    for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
      text.replace(at, from.size(), to);
  };
  replace_all("\"meshes/", "\"" FLOWSKIN_SOURCE_DIR "/scenes/meshes/");
  replace_all("\"tracking\": {", "\"tracking\": {\"wall_share\": 0, ");
  const fs::path file = folder / "preview.json";
  std::ofstream(file) << text;
  return file.string();
}

/// Runs the beginning of the preview with one and with two threads, and without a comparison.
class CompareRun : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = end_to_end::fresh_folder("compare");
    const std::string scene = preview_without_walls(folder_);
    for (const char* threads : {"1", "2"}) {
      const auto result = run_flowskin({"run", scene, "--frames", "4", "--compare", "normal,curvature", "--no-video",
                                        "--out", (folder_ / threads).string(), "--threads", threads});
      ASSERT_EQ(result.status, 0) << result.output;
      output_ = result.output;
    }
    const auto plain = run_flowskin(
        {"run", scene, "--frames", "4", "--no-pictures", "--out", (folder_ / "plain").string(), "--quiet"});
    ASSERT_EQ(plain.status, 0) << plain.output;
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }

  static fs::path folder_;
  static std::string output_;
};

fs::path CompareRun::folder_;
std::string CompareRun::output_;

TEST_F(CompareRun, WritesItsFiles) {
  for (const char* name : {"compare.csv", "compare.md", "compare.svg", "compare.png", "compare_sheet.png",
                           "images/compare_0000.png", "images/compare_0004.png"})
    EXPECT_TRUE(fs::exists(folder_ / "2" / name)) << name;
  EXPECT_FALSE(fs::exists(folder_ / "2" / "images" / "compare_0005.png"));
  EXPECT_FALSE(fs::exists(folder_ / "plain" / "compare.csv"));
}

TEST_F(CompareRun, SameBytesAtOneAndTwoThreads) {
  for (const char* name : {"compare.svg", "compare.png", "compare_sheet.png", "images/compare_0003.png"})
    EXPECT_TRUE(end_to_end::bytes(folder_ / "1" / name) == end_to_end::bytes(folder_ / "2" / name)) << name;
  const Table one(folder_ / "1" / "compare.csv"), two(folder_ / "2" / "compare.csv");
  for (const std::string& column : one.columns()) {
    if (column != "seconds") {
      EXPECT_EQ(one.text(column), two.text(column)) << column;
    }
  }
}

TEST_F(CompareRun, TheScenesOwnRunIsNotDisturbed) {
  for (const std::string& name : end_to_end::files_below(folder_ / "plain" / "surface"))
    EXPECT_TRUE(end_to_end::bytes(folder_ / "plain" / "surface" / name) ==
                end_to_end::bytes(folder_ / "2" / "surface" / name))
        << name;
}

TEST_F(CompareRun, ErrorsBeginAtZeroAndTellTheMethodsApart) {
  const Table table(folder_ / "2" / "compare.csv");
  ASSERT_EQ(table.rows(), 10U);
  const std::vector<std::string> methods = table.text("method");
  for (std::size_t r = 0; r < 10; ++r) {
    EXPECT_EQ(methods[r], r % 2 == 0 ? "normal" : "curvature");
    EXPECT_EQ(table.number("frame", r), double(r / 2));
  }
  for (const std::size_t first : {0, 1}) {
    EXPECT_EQ(table.number("texture_median", first), 0);
    EXPECT_LT(table.number("path_p90", first), 1e-9);
    EXPECT_EQ(table.number("texture_found", first), 1);
    EXPECT_EQ(table.number("vertices_kept", first), 1);
  }
  // The ball flies off: all that `normal` sees of it is the third of the motion that is along the normal.
  EXPECT_NEAR(table.number("tangential_error", 0), 1, 1e-3);
  EXPECT_NEAR(table.number("velocity_error", 0), 0.816, 0.02);
  EXPECT_LT(table.number("velocity_error", 1), 1e-6);
  EXPECT_GT(table.number("texture_median", 8), 5 * table.number("texture_median", 9));
  EXPECT_GT(table.number("seconds", 8), 0);
  EXPECT_GT(table.number("markers", 9), 1000);
}

TEST_F(CompareRun, PrintsTheRankingAtTheEnd) {
  const std::size_t ranking = output_.find("ranking");
  ASSERT_NE(ranking, std::string::npos) << output_;
  EXPECT_LT(output_.find("curvature", ranking), output_.find("normal", ranking));
  EXPECT_GT(ranking, output_.find("in all"));
}

TEST(Compare, UnknownMethodsAndScenesWithoutSurfaceAreWrongInput) {
  const fs::path folder = end_to_end::fresh_folder("compare_errors");
  const auto result = run_flowskin(
      {"run", end_to_end::scene("stairs_preview.json"), "--compare", "normal,fly", "--out", (folder / "run").string()});
  EXPECT_EQ(result.status, 2);
  EXPECT_NE(result.output.find("fly"), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("curvature"), std::string::npos) << result.output;
  EXPECT_FALSE(fs::exists(folder / "run"));
  fs::remove_all(folder);
}

TEST(Compare, WithPrescribedMotionTheTruthIsExact) {
  const fs::path folder = end_to_end::fresh_folder("compare_ring");
  const auto result = run_flowskin({"run", end_to_end::scene("rotating_ring.json"), "--compare", "normal,total",
                                    "--frames", "3", "--no-pictures", "--out", folder.string()});
  ASSERT_EQ(result.status, 0) << result.output;
  EXPECT_NE(result.output.find("prescribed motion"), std::string::npos) << result.output;
  const Table table(folder / "compare.csv");
  const std::size_t last = table.rows() - 1;
  EXPECT_EQ(table.number("markers_left", last), 0);
  EXPECT_LT(table.number("marker_depth", last), 1e-7);
  // Three particles lie in a plane, where rest_position_at is regularised: exact to 1e-4 spacings only.
  EXPECT_LT(table.number("marker_drift", last), 4e-5);
  // Without tangential velocity nothing follows the ring, which turns by 18 degrees.
  EXPECT_GT(table.number("path_median", last - 1), 0.1);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace flowskin
