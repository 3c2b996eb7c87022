// Runs remove and overwrite only what FlowSkin has written, never an input, and never meet in one folder.
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <map>
#include <random>
#include <thread>

#include "end_to_end/small_run.h"
#include "tools/pipeline/run_directory.h"

namespace flowskin::end_to_end {
namespace {

namespace fs = std::filesystem;

class NothingLost : public SmallRunTest {
 protected:
  NothingLost() : SmallRunTest("nothing_lost", {"--quiet", "--threads", "1"}, {.frames = 4, .interval = 2}) {}

  Result run(const fs::path& out, const std::vector<std::string>& more = {}) const {
    return run_flowskin(arguments(out, more));
  }
  /// `flowskin` with this as the working folder, so that the default output folder is below it.
  Result run_here(const std::vector<std::string>& words) const {
    std::vector<std::string> command{"bash", "-c", "cd \"$0\" && exec \"$@\"", folder_.string(),
                                     FLOWSKIN_BINARY_DIR "/flowskin"};
    command.insert(command.end(), words.begin(), words.end());
    return run_program(command);
  }
  static void expect(const Result& result, int status, const std::vector<std::string>& words) {
    EXPECT_EQ(result.status, status) << result.output;
    for (const std::string& word : words) EXPECT_NE(result.output.find(word), std::string::npos) << result.output;
  }
  static void put(const fs::path& file, const std::string& text) {
    fs::create_directories(file.parent_path());
    std::ofstream(file) << text;
  }
  /// All files with what is in them.
  static std::map<std::string, std::string> contents(const fs::path& below) {
    std::map<std::string, std::string> all;
    for (const std::string& name : files_below(below)) all[name] = bytes(below / name);
    return all;
  }
  /// A run that was killed once it had a checkpoint.
  fs::path killed_run(const std::string& name) const {
    const fs::path out = folder_ / name;
    run_flowskin_until(
        arguments(out, {"--frames", "60"}), [&] { return newest_checkpoint(out) >= 2; }, SIGKILL);
    return out;
  }
};

TEST_F(NothingLost, ASceneInTheFolderOfTheRun) {
  const fs::path project = folder_ / "project";
  put(project / "scene.json", bytes(scene()));
  std::string text = bytes(scene());
  text.replace(text.find("box.obj"), 7, "surface/wall.obj");
  put(project / "scene.json", "// by hand\n" + text);
  put(project / "surface/wall.obj", bytes(folder_ / "box.obj"));
  put(project / "images/wood.png", "a picture");
  const auto before = contents(project);
  const std::vector<std::string> words{"scene.json", "overwrite", "--out"};
  expect(run_flowskin({"run", (project / "scene.json").string(), "--out", project.string()}), 2, words);
  expect(run_flowskin({"run", (project / "scene.json").string(), "--out", project.string(), "--overwrite"}), 2, words);
  fs::create_directory_symlink(project, folder_ / "link");
  expect(run_flowskin({"run", (project / "scene.json").string(), "--out", (folder_ / "link").string()}), 2, words);
  EXPECT_EQ(contents(project), before);
}

TEST_F(NothingLost, InputsAreKnownThroughLinks) {
  const fs::path out = folder_ / "run";
  ASSERT_EQ(run(out).status, 0);
  // Files of the run become inputs of the next, by a symbolic and by a hard link.
  std::string text = bytes(scene());
  fs::remove(folder_ / "box.obj");
  fs::create_symlink(out / "surface/frame_0001.obj", folder_ / "box.obj");
  const auto before = contents(out);
  expect(run(out, {"--overwrite"}), 2, {"surface/frame_0001.obj", "overwrite", "box.obj"});
  fs::remove(folder_ / "box.obj");
  fs::create_hard_link(out / "surface/frame_0002.obj", folder_ / "box.obj");
  expect(run(out, {"--overwrite"}), 2, {"surface/frame_0002.obj", "box.obj"});
  expect(run_flowskin({"run", (out / "scene.json").string(), "--out", out.string(), "--overwrite"}), 2, {"scene.json"});
  EXPECT_EQ(contents(out), before);
}

TEST_F(NothingLost, RecordedParticlesInTheFolderOfTheRun) {
  const fs::path project = folder_ / "project", raw = project / "particles/raw";
  std::string cube = "x,y,z\n";  // enough particles for a surface
  for (int i = 0; i < 27; ++i)
    cube += std::to_string(0.1 * (i % 3)) + "," + std::to_string(0.1 * (i / 3 % 3)) + "," +
            std::to_string(0.1 * (i / 9)) + "\n";
  for (int k = 0; k < 3; ++k) put(raw / ("p_" + std::to_string(k) + ".csv"), cube);
  put(project / "log.txt", "mine");
  auto before = contents(project);
  const auto track = [&](const std::string& particles, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"track", particles,       "--spacing", "0.1", "--out",
                                   project, "--no-pictures", "--threads", "1",   "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    return run_flowskin(words);
  };
  expect(track((raw / "*.csv").string()), 2, {"log.txt"});
  EXPECT_EQ(contents(project), before);
  // Where nothing of the run's names is there, the folder is used, and the particles stay.
  fs::remove(project / "log.txt");
  before = contents(project);
  expect(track((raw / "*.csv").string()), 0, {});
  for (const auto& [name, text] : before) EXPECT_EQ(bytes(project / name), text) << name;
  // Particles that FlowSkin itself has written, as a pattern and named by a .pvd.
  const auto after = contents(project);
  for (const char* particles : {"particles/frame_*.ply", "particles/particles.pvd"})
    expect(track((project / particles).string(), {"--overwrite"}), 2, {"particles/", "overwrite", "another folder"});
  EXPECT_EQ(contents(project), after);
}

TEST_F(NothingLost, AFinishedRunIsRefusedWithTheChoice) {
  const fs::path out = folder_ / "run";
  ASSERT_EQ(run(out).status, 0);
  const auto before = contents(out);
  expect(run(out), 2, {"finished run", "4 frames", "--overwrite", "--resume", "--out"});
  EXPECT_EQ(contents(out), before);
  expect(run(out, {"--overwrite", "--resume"}), 2, {"--overwrite"});
}

TEST_F(NothingLost, AnInterruptedRunIsRefusedWithTheChoice) {
  const fs::path out = killed_run("run");
  const auto before = contents(out);
  expect(run(out), 2, {"interrupted", "--overwrite", "--resume", "--out"});
  EXPECT_EQ(contents(out), before);
}

TEST_F(NothingLost, OverwritingKeepsWhatOthersPutThere) {
  const fs::path out = folder_ / "run", straight = folder_ / "straight";
  ASSERT_EQ(run(straight, {"--frames", "2"}).status, 0);
  ASSERT_EQ(run(out).status, 0);
  const std::map<std::string, std::string> mine{
      {"surface/stairs.blend", "a"},   {"images/mine.png", "b"},       {"notes.txt", "c"},
      {"surface/frame_0001.txt", "d"}, {"checkpoint/.keep.part", "e"}, {"holiday.part.mp4", "f"},
      {"surface/frame_0001b.obj", "g"}};
  for (const auto& [name, text] : mine) put(out / name, text);
  // A link in the place of a file goes, not what it leads to.
  put(folder_ / "kept.obj", "kept");
  fs::remove(out / "surface/frame_0003.obj");
  fs::create_symlink(folder_ / "kept.obj", out / "surface/frame_0003.obj");
  ASSERT_EQ(run(out, {"--overwrite", "--frames", "2"}).status, 0);
  EXPECT_EQ(bytes(folder_ / "kept.obj"), "kept");
  for (const auto& [name, text] : mine) {
    EXPECT_EQ(bytes(out / name), text) << name;
    fs::remove(out / name);
  }
  expect_same_results(straight, out);
}

TEST_F(NothingLost, OtherThingsOfTheSameNames) {
  for (const char* name : {"log.txt", "scene.json", "frames.csv", "images/frame_0012.png", "surface/frame_0000.vtp",
                           "compare.md", "particles", "checkpoint/frame_0001.bin", "surface/texture.png"}) {
    const fs::path out = folder_ / "other";
    put(out / name, "mine");
    for (const char* how : {"--overwrite", "--quiet"}) expect(run(out, {how}), 2, {"not empty", name, "--out"});
    EXPECT_EQ(contents(out), (std::map<std::string, std::string>{{name, "mine"}}));
    fs::remove_all(out);
  }
  // What has other names is no obstacle.
  const fs::path out = folder_ / "thesis";
  put(out / "chapter1.txt", "years of work");
  put(out / "images/scan.png", "a scan");
  EXPECT_EQ(run(out, {"--frames", "1"}).status, 0);
  EXPECT_EQ(bytes(out / "chapter1.txt"), "years of work");
  EXPECT_EQ(bytes(out / "images/scan.png"), "a scan");
}

TEST_F(NothingLost, AFolderThatIsALinkIsNotWrittenThrough) {
  const fs::path out = folder_ / "run", elsewhere = folder_ / "elsewhere";
  ASSERT_EQ(run(out).status, 0);
  fs::rename(out / "surface", elsewhere);
  fs::create_directory_symlink(elsewhere, out / "surface");
  const auto before = contents(elsewhere);
  expect(run(out, {"--overwrite"}), 2, {"surface", "link"});
  EXPECT_EQ(contents(elsewhere), before);
  EXPECT_TRUE(fs::exists(out / "frames.csv"));
}

TEST_F(NothingLost, RunsWithoutARecordAreNotTouched) {
  const fs::path out = folder_ / "old";
  ASSERT_EQ(run(out).status, 0);
  fs::remove(out / "flowskin_run.txt");
  const auto before = contents(out);
  for (const char* how : {"--quiet", "--overwrite"}) expect(run(out, {how}), 2, {"flowskin_run.txt", "0.1"});
  expect(run(out, {"--resume"}), 2, {"flowskin_run.txt"});
  EXPECT_EQ(contents(out), before);
}

TEST_F(NothingLost, TheDefaultFolderIsUsedAgainWhileNobodyChangedIt) {
  const std::vector<std::string> words{"run", "small.json", "--quiet", "--frames", "2"};
  const fs::path out = folder_ / "output/small";
  ASSERT_EQ(run_here(words).status, 0);
  put(out / "surface/mine.blend", "mine");
  const auto first = fs::last_write_time(out / "frames.csv");
  const Result again = run_here(words);
  EXPECT_EQ(again.status, 0) << again.output;
  EXPECT_NE(fs::last_write_time(out / "frames.csv"), first);
  EXPECT_EQ(bytes(out / "surface/mine.blend"), "mine");
  ASSERT_EQ(run_flowskin({"render", out.string(), "--quiet", "--no-video", "--width", "32", "--height", "32"}).status,
            0);
  EXPECT_EQ(run_here(words).status, 0);
  // Another scene of the same name.
  put(folder_ / "other/small.json", bytes(scene()));
  fs::copy(folder_ / "box.obj", folder_ / "other/box.obj");
  expect(run_here({"run", "other/small.json", "--quiet"}), 2, {"another scene", "--overwrite", "--out"});
  // A file that somebody has changed.
  std::ofstream(out / "surface/frame_0001.obj", std::ios::app) << "# mine\n";
  expect(run_here(words), 2, {"surface/frame_0001.obj", "changed", "--overwrite"});
  EXPECT_NE(bytes(out / "surface/frame_0001.obj").find("# mine"), std::string::npos);
}

TEST_F(NothingLost, AnInterruptedRunInTheDefaultFolderIsKeptToGoOnWith) {
  fs::create_directories(folder_ / "output");
  fs::rename(killed_run("run"), folder_ / "output/small");
  const auto before = contents(folder_ / "output/small");
  expect(run_here({"run", "small.json", "--quiet"}), 2, {"interrupted", "--resume", "--overwrite"});
  EXPECT_EQ(contents(folder_ / "output/small"), before);
  EXPECT_EQ(run_here({"run", "small.json", "--quiet", "--frames", "60", "--resume"}).status, 0);
}

TEST_F(NothingLost, AfterAKillAtAnyMomentOverwritingLeavesNothingOfTheOldRun) {
  const fs::path out = folder_ / "run", straight = folder_ / "straight";
  ASSERT_EQ(run(straight, {"--frames", "2"}).status, 0);
  std::mt19937 random(5);
  std::uniform_int_distribution<int> milliseconds(1, 400);
  for (int attempt = 0; attempt < 10; ++attempt) {
    const auto due = std::chrono::steady_clock::now() + std::chrono::milliseconds(milliseconds(random));
    const Result result = run_flowskin_until(
        arguments(out, {"--overwrite", "--frames", "60"}), [&] { return std::chrono::steady_clock::now() > due; },
        SIGKILL);
    ASSERT_TRUE(result.status == 128 + SIGKILL || result.status == 0) << result.output;
  }
  const Result last = run(out, {"--overwrite", "--frames", "2"});
  ASSERT_EQ(last.status, 0) << last.output;
  expect_same_results(straight, out);
}

TEST_F(NothingLost, EveryFileOfARunIsKnown) {
  const fs::path out = folder_ / "run";
  const std::string text = bytes(scene());
  std::string drawn = text;
  drawn.replace(drawn.find("\"enabled\": false"), 16, "\"width\": 64, \"height\": 48, \"samples\": 1");
  std::ofstream(scene()) << drawn;
  ASSERT_EQ(run(out, {"--compare", "hybrid,normal"}).status, 0);
  const std::string record = bytes(out / "flowskin_run.txt");
  for (const std::string& name : files_below(out)) {
    EXPECT_TRUE(tools::RunDirectory::is_name_of_run(name)) << name;
    if (name != "flowskin_run.txt") {
      EXPECT_NE(record.find("file " + name + " "), std::string::npos) << name;
    }
  }
}

TEST_F(NothingLost, OfTwoRunsIntoOneNewFolderOneWins) {
  // The set-up of the first is slow enough that the second begins before, during and after it.
  SmallScene slow;
  slow.frames = 1;
  slow.write(scene());
  std::string text = bytes(scene());
  text.replace(text.find("\"spacing\": 0.05"), 15, "\"spacing\": 0.025");
  std::ofstream(scene()) << text;
  const fs::path straight = folder_ / "straight";
  ASSERT_EQ(run(straight).status, 0);
  for (const int delay : {0, 1, 3, 10, 25, 50, 90, 150, 250, 450}) {
    const fs::path out = folder_ / ("race_" + std::to_string(delay));
    Result first;
    std::thread other([&] { first = run(out); });
    std::this_thread::sleep_for(std::chrono::milliseconds(delay));
    const Result second = run(out);
    other.join();
    EXPECT_EQ(std::min(first.status, second.status), 0) << delay << " ms: " << first.output << second.output;
    EXPECT_EQ(std::max(first.status, second.status), 2) << delay << " ms: " << first.output << second.output;
    const std::string& refused = first.status == 0 ? second.output : first.output;
    EXPECT_TRUE(refused.find("another flowskin") != std::string::npos ||
                refused.find("finished run") != std::string::npos)
        << refused;
    expect_same_results(straight, out);
    EXPECT_TRUE(fs::exists(out / "log.txt"));
  }
}

TEST_F(NothingLost, NobodyDrawsPicturesOfARunThatIsGoingOn) {
  const fs::path out = folder_ / "run";
  ASSERT_EQ(run(out, {"--frames", "1"}).status, 0);
  const auto before = contents(out);
  const std::vector<std::string> words{"render", out.string(), "--no-video", "--width", "32", "--height", "32"};
  {
    tools::RunLock other;
    other.create(tools::RunDirectory(out));
    expect(run_flowskin(words), 2, {"another flowskin", out.string()});
  }
  EXPECT_EQ(contents(out), before);
  EXPECT_EQ(run_flowskin(words).status, 0);
}

TEST_F(NothingLost, ASetUpThatFailsLeavesNoFolder) {
  put(folder_ / "wrong.json",
      "{\"frames\": 1, \"particles\": {\"spacing\": 0.1, \"source\": \"recorded\", "
      "\"recorded\": {\"files\": [\"box.obj\"]}}}");
  EXPECT_EQ(run_flowskin({"run", (folder_ / "wrong.json").string(), "--out", (folder_ / "a/b").string()}).status, 2);
  EXPECT_FALSE(fs::exists(folder_ / "a"));
}

TEST_F(NothingLost, AFolderThatIsReplacedDuringTheRunIsNotWrittenTo) {
  const fs::path out = folder_ / "run", moved = folder_ / "moved";
  bool replaced = false;
  const Result result = run_flowskin_until(
      arguments(out, {"--frames", "60"}),
      [&] {
        if (replaced || newest_checkpoint(out) < 2) return false;
        fs::rename(out, moved);
        for (const char* name : {"surface", "particles", "checkpoint", "images"}) fs::create_directories(out / name);
        replaced = true;
        return false;
      },
      SIGKILL);
  ASSERT_TRUE(replaced);
  expect(result, 1, {"replaced", out.string()});
  EXPECT_EQ(result.output.find("are whole"), std::string::npos) << result.output;
  EXPECT_EQ(result.output.find("--resume"), std::string::npos) << result.output;
  EXPECT_EQ(contents(out), (std::map<std::string, std::string>{}));
  // What had been written is a run that can be gone on with, where it is now.
  EXPECT_EQ(run(moved, {"--resume", "--frames", "6"}).status, 0);
}

TEST_F(NothingLost, NoClaimsAboutAFolderThatIsGone) {
  const fs::path out = folder_ / "run";
  const Result result = run_flowskin_until(
      arguments(out, {"--frames", "60"}),
      [&] {
        if (newest_checkpoint(out) < 2) return false;
        std::error_code error;
        for (int attempt = 0; attempt < 1000 && fs::exists(out); ++attempt) fs::remove_all(out, error);
        return false;
      },
      SIGKILL);
  expect(result, 1, {out.string(), "removed"});
  EXPECT_EQ(result.output.find("are whole"), std::string::npos) << result.output;
  EXPECT_EQ(result.output.find("--resume"), std::string::npos) << result.output;
}

}  // namespace
}  // namespace flowskin::end_to_end
