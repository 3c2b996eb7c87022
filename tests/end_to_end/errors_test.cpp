// What the program does when something is wrong: one clear message, the right exit status, nothing lost.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "end_to_end/program.h"

namespace flowskin {
namespace {

namespace fs = std::filesystem;
using end_to_end::run_flowskin;

class ProgramErrors : public ::testing::Test {
 protected:
  void SetUp() override { folder_ = end_to_end::fresh_folder("errors"); }
  void TearDown() override { fs::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }
  static void expect(const end_to_end::Result& result, int status, const std::vector<std::string>& words) {
    EXPECT_EQ(result.status, status) << result.output;
    for (const std::string& word : words) EXPECT_NE(result.output.find(word), std::string::npos) << result.output;
    EXPECT_LT(std::count(result.output.begin(), result.output.end(), '\n'), 12) << result.output;
  }

  fs::path folder_;
};

TEST_F(ProgramErrors, HelpAndVersion) {
  expect(run_flowskin({"--version"}), 0, {"flowskin 0."});
  EXPECT_EQ(run_flowskin({"--help"}).status, 0);
  for (const char* command : {"run", "render", "info", "methods", "scene"})
    EXPECT_NE(run_flowskin({"--help"}).output.find(command), std::string::npos) << command;
  EXPECT_EQ(run_flowskin({"run", "--help"}).status, 0);
  expect(run_flowskin({"methods"}), 0, {"normal", "total", "curvature"});
}

TEST_F(ProgramErrors, WrongCommandLines) {
  expect(run_flowskin({}), 2, {"A subcommand is required"});
  expect(run_flowskin({"fly"}), 2, {"fly"});
  expect(run_flowskin({"run"}), 2, {"scene"});
  expect(run_flowskin({"run", end_to_end::scene("stairs_preview.json"), "--velocity", "curvatur"}), 2,
         {"--velocity", "curvature"});
  expect(run_flowskin({"run", end_to_end::scene("stairs_preview.json"), "--threads", "0"}), 2, {"--threads"});
}

TEST_F(ProgramErrors, WrongScenes) {
  expect(run_flowskin({"run", (folder_ / "none.json").string()}), 2, {"none.json"});
  expect(run_flowskin({"run", write("broken.json", "{ \"frames\": ")}), 2, {"broken.json"});
  expect(run_flowskin({"run", write("key.json", "{\n  \"frame\": 3\n}")}), 2, {"key.json", "frame", "frames", "2"});
}

TEST_F(ProgramErrors, AForeignFolderIsNotTouched) {
  const fs::path foreign = folder_ / "thesis";
  fs::create_directories(foreign);
  std::ofstream(foreign / "chapter1.txt") << "years of work";
  std::ofstream(foreign / "log.txt") << "the years";
  expect(run_flowskin({"run", end_to_end::scene("stairs_preview.json"), "--out", foreign.string()}), 2,
         {"thesis", "not empty"});
  EXPECT_EQ(end_to_end::bytes(foreign / "chapter1.txt"), "years of work");
  EXPECT_EQ(end_to_end::bytes(foreign / "log.txt"), "the years");
  EXPECT_EQ(end_to_end::files_below(foreign).size(), 2U);
}

TEST_F(ProgramErrors, OutIsAFile) {
  const std::string file = write("file", "x");
  expect(run_flowskin({"run", end_to_end::scene("stairs_preview.json"), "--out", file}), 2, {file});
  EXPECT_EQ(end_to_end::bytes(file), "x");
  for (const std::string& name : {std::string(300, 'a'), "a/" + std::string(300, 'b') + "/c"})
    expect(run_flowskin({"run", end_to_end::scene("stairs_preview.json"), "--out", (folder_ / name).string()}), 2,
           {"so long a name"});
  EXPECT_FALSE(fs::exists(folder_ / "a"));
}

TEST_F(ProgramErrors, RenderWithoutARun) {
  expect(run_flowskin({"render", folder_.string()}), 2, {"scene.json"});
  expect(run_flowskin({"render", (folder_ / "nowhere").string()}), 2, {"nowhere"});
}

TEST_F(ProgramErrors, InfoOfSomethingElse) {
  expect(run_flowskin({"info", write("notes.txt", "hello")}), 2, {"notes.txt"});
  expect(run_flowskin({"info", write("bad.ply", "ply\nformat ascii 1.0\nelement vertex 5\n")}), 2, {"bad.ply"});
}

TEST_F(ProgramErrors, InfoGoesOnAfterABadFile) {
  const auto result =
      run_flowskin({"info", write("bad.ply", "ply\n"), write("good.csv", "x,y,z\n1,2,3\n1,2,4\n1,3,3\n"),
                    write("places.json", "[[0, 0, 0], [0, 0, 1], [0, 1, 0]]")});
  EXPECT_EQ(result.status, 2) << result.output;
  for (const char* word : {"1 of 3 files cannot be read: bad.ply", "particles: 3 (CSV)", "particles: 3 (JSON)"})
    EXPECT_NE(result.output.find(word), std::string::npos) << word << "\n" << result.output;
}

TEST_F(ProgramErrors, ControlCharactersOfFilesDoNotReachTheTerminal) {
  const auto result = run_flowskin({"info", write("a\x1b[31m.csv", "id,x,y,z\n0,0,0,0\n1,\x1b[2J\x07red,0,0\n")});
  expect(result, 2, {"a\\x1b[31m.csv", "found \"\\x1b[2J\\x07red\""});
  EXPECT_EQ(result.output.find('\x1b'), std::string::npos) << result.output;
}

TEST_F(ProgramErrors, JsonThatIsNeitherASceneNorParticles) {
  expect(run_flowskin({"info", write("empty.json", "{}")}), 2, {"empty.json", "neither a scene nor particles"});
  expect(run_flowskin({"info", write("slip.json", R"({"partikles": 1})")}), 2, {"did you mean \"particles\"?"});
  expect(run_flowskin({"track", (folder_ / "empty.json").string()}), 2, {"the object is empty", "positions"});
}

/// There is nothing to go on with where a whole run found no surface.
TEST_F(ProgramErrors, NoSurfaceAtAll) {
  const std::string file = write("a.csv", "x,y,z\n0,0,0\n1,0,0\n2,0,0\n");
  const auto result = run_flowskin({"track", file, "--out", (folder_ / "out").string(), "--no-pictures", "--quiet"});
  expect(result, 1, {"no frame has a surface", "3 particles at most"});
  EXPECT_EQ(result.output.find("--resume"), std::string::npos) << result.output;
  EXPECT_EQ(result.output.find("are whole"), std::string::npos) << result.output;
}

TEST_F(ProgramErrors, InterruptionKeepsWholeFrames) {
  const fs::path out = folder_ / "run";
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGINT, SIG_DFL);  // a shell that runs the tests in the background has it ignored
    execl(FLOWSKIN_BINARY_DIR "/flowskin", "flowskin", "run", end_to_end::scene("stairs_preview.json").c_str(), "--out",
          out.c_str(), "--quiet", "--no-pictures", nullptr);
    _exit(127);
  }
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(5);
  while (!fs::exists(out / "surface/frame_0002.ply") && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  kill(child, SIGINT);
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 128 + SIGINT);
  const end_to_end::Table table(out / "frames.csv");
  EXPECT_GE(table.rows(), 3u);
  for (const auto& name : end_to_end::files_below(out))
    if (name.find("surface/frame_") == 0 && name.find(".ply") != std::string::npos) {
      EXPECT_EQ(run_flowskin({"info", (out / name).string()}).status, 0) << name;
    }
}

}  // namespace
}  // namespace flowskin
