// Disks that fail and simulations that blow up: one message, the right exit status, what was written stays valid.
#include <gtest/gtest.h>
#include <sys/mount.h>

#include <csignal>

#include "end_to_end/small_run.h"

namespace flowskin::end_to_end {
namespace {

namespace fs = std::filesystem;

class Trouble : public SmallRunTest {
 protected:
  Trouble() : SmallRunTest("trouble", {"--quiet"}) {}

  static void expect(const Result& result, int status, const std::vector<std::string>& words) {
    EXPECT_EQ(result.status, status) << result.output;
    for (const std::string& word : words) EXPECT_NE(result.output.find(word), std::string::npos) << result.output;
    EXPECT_LT(std::count(result.output.begin(), result.output.end(), '\n'), 8) << result.output;
  }
  /// Every file that is there can be read, and nothing is half written.
  static void expect_sound(const fs::path& run) {
    std::vector<std::string> surfaces{"info"};
    for (const std::string& name : files_below(run)) {
      EXPECT_FALSE(name.ends_with(".part")) << name;
      if (name.ends_with(".ply") || name.ends_with(".obj")) surfaces.push_back((run / name).string());
    }
    ASSERT_GT(surfaces.size(), 1U);
    EXPECT_EQ(run_flowskin(surfaces).status, 0);
    const Table table(run / "frames.csv");
    EXPECT_GT(table.rows(), 0U);
  }
};

TEST_F(Trouble, FullDisk) {
  const fs::path disk = folder_ / "disk";
  fs::create_directories(disk);
  if (mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=3m") != 0)
    GTEST_SKIP() << "a small file system cannot be mounted here (not root, or not allowed)";
  const fs::path out = disk / "run";
  const Result result = run_flowskin(arguments(out));
  expect(result, 1, {"No space left on device", "cannot write", "free some space", "whole in"});
  expect_sound(out);
  // With space again it goes on, where a checkpoint had found room.
  const int saved = newest_checkpoint(out);
  if (saved >= 0 && mount("tmpfs", disk.c_str(), "tmpfs", MS_REMOUNT, "size=60m") == 0) {
    ASSERT_EQ(run_flowskin(arguments(out, {"--resume"})).status, 0);
    const fs::path straight = folder_ / "straight";
    ASSERT_EQ(run_flowskin(arguments(straight)).status, 0);
    expect_same_results(straight, out);
  }
  umount2(disk.c_str(), MNT_DETACH);
}

TEST_F(Trouble, FilesMayNotGrow) {
  // 40 kB: the first surfaces fit, later ones do not. The signal for it must not kill.
  const fs::path out = folder_ / "run";
  const Result result = run_program({"bash", "-c", "ulimit -f 80; exec \"$@\"", "bash", FLOWSKIN_BINARY_DIR "/flowskin",
                                     "run", scene().string(), "--out", out.string(), "--quiet"});
  expect(result, 1, {"File too large", "cannot write", "ulimit -f"});
  for (const std::string& name : files_below(out)) EXPECT_FALSE(name.ends_with(".part")) << name;
}

TEST_F(Trouble, TheFolderIsRemovedDuringTheRun) {
  const fs::path out = folder_ / "run";
  const Result result = run_flowskin_until(
      arguments(out),
      [&] {
        if (!fs::exists(out / "surface/frame_0002.ply")) return false;
        std::error_code error;
        for (int attempt = 0; attempt < 1000 && fs::exists(out); ++attempt) fs::remove_all(out, error);
        return false;
      },
      SIGKILL);
  expect(result, 1, {"cannot write", out.string(), "removed meanwhile"});
}

TEST_F(Trouble, AFolderThatMayNotBeWritten) {
  expect(run_flowskin(arguments("/proc/flowskin/run")), 1, {"/proc/flowskin/run", "cannot prepare"});
}

TEST_F(Trouble, ABlowUpCanBeResumedWithTheSettingThatItNames) {
  small_.simulation = "\"speed_of_sound\": 2.6, ";
  small_.interval = 1;
  small_.write(scene());
  const fs::path out = folder_ / "run";
  const Result result = run_flowskin(arguments(out));
  expect(result, 1,
         {"in frame ", "blew up", "particle ", "faster than the speed of sound", "raise speed_of_sound",
          "may be changed", "--resume"});
  expect_sound(out);
  const int saved = newest_checkpoint(out);
  ASSERT_GE(saved, 1);
  // Without a change it blows up again.
  expect(run_flowskin(arguments(out, {"--resume"})), 1, {"blew up"});
  small_.simulation = "\"speed_of_sound\": 40, ";
  small_.write(scene());
  const Result again = run_flowskin({"run", scene().string(), "--out", out.string(), "--resume"});
  EXPECT_EQ(again.status, 0) << again.output;
  EXPECT_NE(again.output.find("simulation.speed_of_sound: 2.6, now 40"), std::string::npos) << again.output;
  expect_sound(out);
  EXPECT_EQ(Table(out / "frames.csv").rows(), 13U);
}

TEST_F(Trouble, NoCheckpointsWhereNoneAreWanted) {
  small_.interval = 0;
  small_.write(scene());
  const fs::path out = folder_ / "run";
  const Result result = run_flowskin_until(
      arguments(out), [&] { return fs::exists(out / "surface/frame_0003.ply"); }, SIGINT);
  EXPECT_EQ(result.status, 130) << result.output;
  EXPECT_EQ(result.output.find("--resume"), std::string::npos) << result.output;
  expect(run_flowskin(arguments(out, {"--resume"})), 2, {"nothing to resume", "checkpoint_interval"});
}

}  // namespace
}  // namespace flowskin::end_to_end
