// flowskin paper --quick: all files are there, and what must hold holds.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

#include "end_to_end/program.h"
#include "tools/textures/image.h"

namespace flowskin {
namespace {

namespace fs = std::filesystem;
using end_to_end::run_flowskin;
using end_to_end::Table;

const std::string scenes_folder = FLOWSKIN_SOURCE_DIR "/scenes/paper";

class Paper : public ::testing::Test {
 protected:
  // One run serves all tests.
  static void SetUpTestSuite() {
    folder_ = end_to_end::fresh_folder("paper");
    result_ = run_flowskin({"paper", "--quick", "--scenes", scenes_folder, "--out", out().string(), "--quiet"});
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }
  void SetUp() override { ASSERT_EQ(result_.status, 0) << result_.output; }

  static fs::path out() { return folder_ / "results"; }
  static Table table(const std::string& name) { return Table(out() / name); }

  // A number of the only row where these columns hold these values.
  static double number(const Table& from, const std::vector<std::pair<std::string, std::string>>& where,
                       const std::string& column) {
    double found = std::nan("");
    int rows = 0;
    for (std::size_t row = 0; row < from.rows(); ++row) {
      bool matches = true;
      for (const auto& [key, value] : where) matches = matches && from.text(key)[row] == value;
      if (!matches) continue;
      found = from.number(column, row);
      ++rows;
    }
    EXPECT_EQ(rows, 1);
    return found;
  }

  static inline fs::path folder_;
  static inline end_to_end::Result result_;
};

TEST_F(Paper, AllFilesAreThere) {
  const std::vector<std::string> files = end_to_end::files_below(out());
  const std::set<std::string> there(files.begin(), files.end());
  for (const char* name : {"summary.md",
                           "verdicts.csv",
                           "paper_log.txt",
                           "translation.csv",
                           "translation.png",
                           "translation_errors.svg",
                           "translation_errors.png",
                           "circling.csv",
                           "circling.svg",
                           "circling.png",
                           "circling_ball.png",
                           "circling_pair.png",
                           "ring.csv",
                           "ring.svg",
                           "ring.png",
                           "ring_velocity.svg",
                           "ring_strong.png",
                           "ring_medium.png",
                           "ring_weak.png",
                           "springs.csv",
                           "springs.svg",
                           "targets.csv",
                           "targets.svg",
                           "convergence.csv",
                           "convergence.svg",
                           "convergence.png",
                           "timing.csv",
                           "timing.svg",
                           "stairs.csv",
                           "stairs.png",
                           "stairs_drift.svg"})
    EXPECT_TRUE(there.count(name)) << name;
  for (const std::string& name : files) {
    if (fs::path(name).extension() == ".png") {
      EXPECT_GT(tools::read_image(out() / name).width, 100) << name;
    }
    if (fs::path(name).extension() == ".svg") {
      EXPECT_NE(end_to_end::bytes(out() / name).find("</svg>"), std::string::npos) << name;
    }
  }
}

TEST_F(Paper, EveryClaimHasAVerdictAndEveryPictureIsShown) {
  const std::string summary = end_to_end::bytes(out() / "summary.md");
  const Table verdicts = table("verdicts.csv");
  ASSERT_GE(verdicts.rows(), 20u);
  const std::set<std::string> known{"confirmed", "confirmed in part", "not confirmed"};
  for (std::size_t row = 0; row < verdicts.rows(); ++row) {
    EXPECT_TRUE(known.count(verdicts.text("verdict")[row])) << verdicts.text("verdict")[row];
    EXPECT_NE(verdicts.text("measured")[row], "");
  }
  for (const char* figure : {"Fig. 2", "Figs. 4, 8, 9", "Fig. 6", "Fig. 7", "Fig. 10", "Sec. 4"})
    EXPECT_NE(summary.find(figure), std::string::npos) << figure;
  const std::set<std::string> unlisted{"summary.md", "verdicts.csv", "paper_log.txt"};
  for (const std::string& name : end_to_end::files_below(out())) {
    EXPECT_TRUE(unlisted.count(name) || summary.find("(" + name + ")") != std::string::npos) << name;
  }
}

TEST_F(Paper, TablesAreNumbers) {
  for (const char* name :
       {"translation.csv", "circling.csv", "ring.csv", "convergence.csv", "springs.csv", "targets.csv"}) {
    const Table rides = table(name);
    ASSERT_GT(rides.rows(), 0u) << name;
    for (std::size_t row = 0; row < rides.rows(); ++row)
      for (const char* column : {"return_error_mean", "path_error", "end_error_max", "velocity_error", "edge_strain"})
        EXPECT_GE(rides.number(column, row), 0) << name << " row " << row << " " << column;
  }
}

TEST_F(Paper, ATranslationIsExactButForTheNormalVelocity) {
  const Table rides = table("translation.csv");
  EXPECT_LT(number(rides, {{"method", "total"}}, "end_error_max"), 1e-6);
  EXPECT_LT(number(rides, {{"method", "curvature"}}, "end_error_max"), 1e-6);
  EXPECT_GT(number(rides, {{"method", "normal"}}, "end_error_mean"), 0.1);
}

TEST_F(Paper, TheBestMethodFollowsTheRing) {
  const Table rides = table("ring.csv");
  const auto velocity_error = [&](const char* scene, const char* method) {
    return number(rides, {{"scene", scene}, {"method", method}, {"fairing_iterations", "10"}}, "velocity_error");
  };
  for (const char* scene : {"ring_strong", "ring_medium", "ring_weak"}) {
    EXPECT_LT(velocity_error(scene, "curvature"), velocity_error(scene, "total")) << scene;
    EXPECT_LT(velocity_error(scene, "rigid-global"), 0.1 * velocity_error(scene, "curvature")) << scene;
  }
}

TEST_F(Paper, AForeignFolderIsNotTouched) {
  const fs::path foreign = folder_ / "thesis";
  fs::create_directories(foreign);
  std::ofstream(foreign / "chapter1.csv") << "years of work";
  const auto result = run_flowskin({"paper", "--quick", "--scenes", scenes_folder, "--out", foreign.string()});
  EXPECT_EQ(result.status, 2) << result.output;
  EXPECT_NE(result.output.find("not empty"), std::string::npos) << result.output;
  EXPECT_EQ(end_to_end::bytes(foreign / "chapter1.csv"), "years of work");
}

TEST_F(Paper, MissingScenesAndImpossibleFolders) {
  const fs::path nowhere = folder_ / "nowhere";
  auto result = run_flowskin({"paper", "--quick", "--scenes", nowhere.string(), "--out", (folder_ / "x").string()});
  EXPECT_EQ(result.status, 2);
  EXPECT_NE(result.output.find(nowhere.string()), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("--scenes"), std::string::npos) << result.output;
  EXPECT_FALSE(fs::exists(folder_ / "x"));

  const fs::path file = folder_ / "file";
  std::ofstream(file) << "x";
  result = run_flowskin({"paper", "--quick", "--scenes", scenes_folder, "--out", file.string()});
  EXPECT_EQ(result.status, 2);
  EXPECT_NE(result.output.find(file.string()), std::string::npos) << result.output;

  result = run_flowskin({"paper", "--quick", "--scenes", scenes_folder, "--out", (file / "below").string()});
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.output.find("below"), std::string::npos) << result.output;
}

TEST_F(Paper, ItsScenesRunAsTheyAre) {
  for (const auto& entry : fs::directory_iterator(scenes_folder)) {
    const fs::path run = folder_ / entry.path().stem();
    const auto result = run_flowskin(
        {"run", entry.path().string(), "--frames", "1", "--no-pictures", "--out", run.string(), "--quiet"});
    EXPECT_EQ(result.status, 0) << result.output;
    EXPECT_TRUE(fs::exists(run / "surface/frame_0001.ply"));
  }
}

}  // namespace
}  // namespace flowskin
