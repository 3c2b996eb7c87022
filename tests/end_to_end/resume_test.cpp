// Runs that are stopped and resumed give the same bytes as runs that are not, wherever and however they are stopped.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <random>

#include "end_to_end/small_run.h"

namespace flowskin::end_to_end {
namespace {

namespace fs = std::filesystem;

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// The straight run that all others are compared with, made once.
class Resume : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = fresh_folder("resume");
    SmallScene().write(scene());
    const double start = now();
    const Result result = run(straight(), {"--threads", "2"});
    duration_ = now() - start;
    ASSERT_EQ(result.status, 0) << result.output;
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }

  static fs::path scene() { return folder_ / "small.json"; }
  static fs::path straight() { return folder_ / "straight"; }
  static std::vector<std::string> arguments(const fs::path& out, const std::vector<std::string>& more) {
    std::vector<std::string> all{"run", scene().string(), "--out", out.string()};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  static Result run(const fs::path& out, const std::vector<std::string>& more) {
    return run_flowskin(arguments(out, more));
  }
  static void expect(const Result& result, int status, const std::vector<std::string>& words) {
    EXPECT_EQ(result.status, status) << result.output;
    for (const std::string& word : words) EXPECT_NE(result.output.find(word), std::string::npos) << result.output;
  }
  /// A run stopped after the checkpoint of frame 6.
  static fs::path stopped_run(const std::string& name) {
    const fs::path out = folder_ / name;
    const Result result = run_flowskin_until(
        arguments(out, {}), [&] { return newest_checkpoint(out) >= 6; }, SIGKILL);
    EXPECT_EQ(result.status, 128 + SIGKILL) << result.output;
    return out;
  }

  static fs::path folder_;
  static double duration_;
};

fs::path Resume::folder_;
double Resume::duration_ = 0;

TEST_F(Resume, AfterCtrlCAtRandomMoments) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(0.05, 0.6);
  const fs::path out = folder_ / "ctrl_c";
  int stops = 0;
  for (int attempt = 0; attempt < 8; ++attempt) {
    std::vector<std::string> more{"--threads", attempt % 2 ? "2" : "1"};
    more.emplace_back(newest_checkpoint(out) >= 0 ? "--resume" : "--overwrite");
    const double due = now() + share(random) * duration_;
    const Result result = run_flowskin_until(
        arguments(out, more), [&] { return now() > due; }, attempt % 3 == 2 ? SIGTERM : SIGINT);
    if (result.status == 0) break;
    if (result.output.empty()) continue;  // killed before the program caught signals
    ++stops;
    expect(result, attempt % 3 == 2 ? 143 : 130, {"interrupted by SIG", "--resume", "frames 0 to"});
  }
  EXPECT_GE(stops, 1);
  Result last = run(out, {"--resume", "--threads", "2"});
  EXPECT_EQ(last.status, 0) << last.output;
  expect_same_results(straight(), out);
}

TEST_F(Resume, AfterKillAtRandomMoments) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> share(0.1, 0.9);
  const fs::path out = folder_ / "killed";
  int resumed = 0;
  for (int attempt = 0; attempt < 6; ++attempt) {
    const int saved = newest_checkpoint(out);
    std::vector<std::string> more{"--threads", attempt % 2 ? "1" : "2"};
    more.emplace_back(saved >= 0 ? "--resume" : "--overwrite");
    resumed += saved >= 0;
    const double due = now() + share(random) * duration_;
    // The first kill waits for a save, so that there is something to resume however slow the machine is.
    const Result result = run_flowskin_until(
        arguments(out, more), [&] { return now() > due && (attempt > 0 || newest_checkpoint(out) >= 0); }, SIGKILL);
    if (result.status == 0) break;
    ASSERT_EQ(result.status, 128 + SIGKILL) << result.output;
    // Lost are at most the frames since the last save.
    if (fs::exists(out / "frames.csv")) {
      const int last = int(Table(out / "frames.csv").rows()) - 1;
      const int saved_by_then = last / 3 * 3 - (last % 3 == 0 ? 3 : 0);  // 0: the first frame, which needs no save
      EXPECT_GE(std::max(newest_checkpoint(out), 0), saved_by_then) << "after frame " << last;
    }
  }
  EXPECT_GE(resumed, 1);
  const Result last = run(out, {newest_checkpoint(out) < 0 ? "--overwrite" : "--resume"});
  ASSERT_EQ(last.status, 0) << last.output;
  expect_same_results(straight(), out);
}

TEST_F(Resume, AfterKillInTheMiddleOfWriting) {
  // Killed the moment that a half written file is seen: of a surface, of frames.csv, of a checkpoint.
  const fs::path out = folder_ / "writing";
  const std::vector<std::string> places{"surface", "checkpoint", "", "particles", "checkpoint"};
  int left_behind = 0;
  for (std::size_t k = 0; k < places.size(); ++k) {
    std::vector<std::string> more{"--threads", "2"};
    const int saved = newest_checkpoint(out);
    more.emplace_back(saved >= 0 ? "--resume" : "--overwrite");
    const fs::path place = out / places[k];
    const auto writing = [&] {
      std::error_code error;
      for (fs::directory_iterator entry(place, error), end; !error && entry != end; entry.increment(error))
        if (entry->path().extension() == ".part" && (saved >= 0 || newest_checkpoint(out) >= 0)) return true;
      return false;
    };
    const Result result = run_flowskin_until(arguments(out, more), writing, SIGKILL);
    if (result.status == 0) break;
    for (const std::string& name : files_below(out)) left_behind += name.ends_with(".part");
  }
  if (left_behind == 0) std::printf("no kill hit a file while it was written\n");
  const Result last = run(out, {newest_checkpoint(out) < 0 ? "--overwrite" : "--resume"});
  ASSERT_EQ(last.status, 0) << last.output;
  expect_same_results(straight(), out);
}

TEST_F(Resume, ASecondSignalStopsAtOnceAndLeavesNoHalfFiles) {
  const fs::path out = folder_ / "twice";
  const Result result = run_flowskin_until(
      arguments(out, {}), [&] { return newest_checkpoint(out) >= 3; }, SIGTERM, 2);
  // Either the second one came in time, or the first had already ended the run.
  EXPECT_EQ(result.status, 128 + SIGTERM) << result.output;
  for (const std::string& name : files_below(out)) EXPECT_FALSE(name.ends_with(".part")) << name;
  ASSERT_EQ(run(out, {"--resume"}).status, 0);
  expect_same_results(straight(), out);
}

TEST_F(Resume, WhereThereIsNothingToResume) {
  expect(run(folder_ / "nowhere", {"--resume"}), 2, {"nothing to resume", "nowhere", "does not exist"});
  EXPECT_FALSE(fs::exists(folder_ / "nowhere"));
  fs::create_directories(folder_ / "empty");
  expect(run(folder_ / "empty", {"--resume"}), 2, {"nothing to resume", "no checkpoint", "checkpoint_interval"});
}

TEST_F(Resume, WhereAllIsDone) {
  const auto before = files_below(straight());
  expect(run(straight(), {"--resume"}), 0, {"complete", "12 frames"});
  EXPECT_EQ(files_below(straight()), before);
}

TEST_F(Resume, GoesOnBeyondTheEnd) {
  const fs::path longer = folder_ / "longer", extended = folder_ / "extended";
  ASSERT_EQ(run(longer, {"--frames", "14"}).status, 0);
  ASSERT_EQ(run(extended, {"--frames", "11"}).status, 0);
  const Result result = run(extended, {"--frames", "14", "--resume"});
  ASSERT_EQ(result.status, 0) << result.output;
  EXPECT_NE(result.output.find("resumed after frame 11"), std::string::npos) << result.output;
  expect_same_results(longer, extended);
  expect(run(extended, {"--frames", "5", "--resume"}), 2, {"after frame 14", "5 frames"});
}

TEST_F(Resume, AnotherSceneIsRefused) {
  const fs::path out = stopped_run("other_scene");
  const std::string text = bytes(scene());
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    changed.replace(changed.find(from), from.size(), to);
    std::ofstream(scene()) << changed;
    const Result result = run(out, {"--resume"});
    std::ofstream(scene()) << text;
    return result;
  };
  expect(with("\"viscosity\": 0.01", "\"viscosity\": 0.02"), 2, {"fluid.viscosity", "checkpoint/frame_0006.bin"});
  expect(with("0.09, \"speed\": 2", "0.09, \"speed\": 3"), 2, {"emitters[0].speed"});
  expect(run(out, {"--resume", "--velocity", "affine"}), 2, {"tracking.velocity"});
  expect(run(out, {"--resume", "--compare", "affine"}), 2, {"no --compare"});
  const std::string box = bytes(folder_ / "box.obj");
  std::ofstream(folder_ / "box.obj") << box << "f 5 6 7 8\n";
  expect(run(out, {"--resume"}), 2, {"boundaries[0].file", "what is in the file"});
  std::ofstream(folder_ / "box.obj") << box;
  // What the particles and the surface do not depend on may change.
  const Result result = with("\"enabled\": false", "\"enabled\": false, \"width\": 320");
  EXPECT_EQ(result.status, 0) << result.output;
}

TEST_F(Resume, DamagedCheckpointsAreRefused) {
  const fs::path out = stopped_run("damaged");
  const fs::path file = out / "checkpoint" / "frame_0006.bin";
  ASSERT_TRUE(fs::exists(file));
  const std::string sound = bytes(file);
  const auto refused = [&](const std::string& content, const std::vector<std::string>& words) {
    std::ofstream(file, std::ios::binary) << content;
    const Result result = run(out, {"--resume"});
    expect(result, 2, words);
    EXPECT_NE(result.output.find("frame_0006.bin"), std::string::npos) << result.output;
    EXPECT_LE(std::count(result.output.begin(), result.output.end(), '\n'), 1) << result.output;
  };
  std::mt19937 random(3);
  for (int k = 0; k < 3; ++k) {
    std::string damaged = sound;
    damaged[30 + random() % (damaged.size() - 60)] ^= char(1 << random() % 8);
    refused(damaged, {"damaged", "delete it"});
  }
  refused(sound.substr(0, sound.size() / 2), {"cut short"});
  refused(sound.substr(0, 10), {"no checkpoint"});
  refused("", {"no checkpoint"});
  refused("ply\nformat ascii 1.0\n" + sound, {"no checkpoint"});
  std::string other_format = sound;
  other_format[20] = 77;
  refused(other_format, {"format 77"});
  // The one before is still there: as the message says, deleting the damaged one goes on from it.
  fs::remove(file);
  const Result result = run(out, {"--resume"});
  ASSERT_EQ(result.status, 0) << result.output;
  EXPECT_NE(result.output.find("resumed after frame 3"), std::string::npos) << result.output;
  expect_same_results(straight(), out);
}

TEST_F(Resume, AtMostTwoCheckpointsAreKeptAndOneAtTheEnd) {
  EXPECT_EQ(files_below(straight() / "checkpoint"), (std::vector<std::string>{"complete.txt", "frame_0012.bin"}));
  const fs::path out = stopped_run("kept");
  std::size_t kept = 0;
  for (const std::string& name : files_below(out / "checkpoint")) kept += name.ends_with(".bin");
  EXPECT_EQ(kept, 2U);
}

TEST_F(Resume, OneRunAtATimeInAFolder) {
  const fs::path out = folder_ / "locked";
  Result second;
  run_flowskin_until(
      arguments(out, {}),
      [&] {
        if (newest_checkpoint(out) < 3) return false;
        second = run(out, {"--resume"});
        return true;
      },
      SIGKILL);
  expect(second, 2, {"another flowskin", out.string()});
}

TEST_F(Resume, ComputingTimeAddsUp) {
  const fs::path out = stopped_run("times");
  ASSERT_EQ(run(out, {"--resume"}).status, 0);
  const std::string log = bytes(out / "log.txt");
  const auto seconds = [&](const std::string& stage) {
    const std::size_t place = log.rfind("  " + stage);
    EXPECT_NE(place, std::string::npos) << stage;
    return place == std::string::npos ? 0 : std::stod(log.substr(place + 2 + 20));
  };
  const Table table(out / "frames.csv");
  for (const char* stage : {"source", "tracking"}) {
    double sum = 0;
    for (std::size_t row = 0; row < table.rows(); ++row) sum += table.number(std::string("seconds_") + stage, row);
    // The rows before the checkpoint were computed by the other process.
    EXPECT_NEAR(seconds(stage), sum, 0.01 + 0.01 * sum) << stage;
  }
  const double parts = seconds("  neighbours") + seconds("  forces") + seconds("  integration");
  EXPECT_GT(parts, 0);
  EXPECT_LE(parts, seconds("source") + 0.02);
  EXPECT_GE(seconds("in all"), seconds("source") + seconds("tracking"));
}

TEST_F(Resume, ComparisonsAndPicturesAreResumedToo) {
  const fs::path file = folder_ / "compare.json";
  SmallScene small;
  small.frames = 4;
  small.interval = 2;
  small.write(file);
  std::string text = bytes(file);
  text.replace(text.find("\"enabled\": false"), 16, "\"width\": 64, \"height\": 48, \"samples\": 1");
  std::ofstream(file) << text;
  const auto compare = [&](const fs::path& out) {
    return std::vector<std::string>{"run",       file.string(),   "--out",  out.string(),
                                    "--compare", "hybrid,normal", "--quiet"};
  };
  const Result whole = run_flowskin(compare(folder_ / "compared"));
  ASSERT_EQ(whole.status, 0) << whole.output;
  const fs::path out = folder_ / "compared_again";
  const Result stopped = run_flowskin_until(
      compare(out), [&] { return fs::exists(out / "images/compare_0003.png"); }, SIGINT);
  EXPECT_EQ(stopped.status, 130) << stopped.output;
  std::vector<std::string> again = compare(out);
  again.emplace_back("--resume");
  const Result resumed = run_flowskin(again);
  ASSERT_EQ(resumed.status, 0) << resumed.output;
  // compare.md tells seconds.
  fs::remove(folder_ / "compared/compare.md");
  fs::remove(out / "compare.md");
  expect_same_results(folder_ / "compared", out);
}

TEST_F(Resume, TrackingOfRecordedParticlesIsResumedToo) {
  const std::string particles = (straight() / "particles/frame_%04d.ply").string();
  const auto track = [&](const fs::path& out) {
    return std::vector<std::string>{"track", particles, "--out", out.string(), "--no-pictures", "--frame-rate", "40"};
  };
  const Result whole = run_flowskin(track(folder_ / "tracked"));
  ASSERT_EQ(whole.status, 0) << whole.output;
  const fs::path out = folder_ / "tracked_again";
  const Result stopped = run_flowskin_until(
      track(out), [&] { return fs::exists(out / "surface/frame_0005.ply"); }, SIGINT);
  EXPECT_EQ(stopped.status, 130) << stopped.output;
  std::vector<std::string> again = track(out);
  again.emplace_back("--resume");
  const Result resumed = run_flowskin(again);
  ASSERT_EQ(resumed.status, 0) << resumed.output;
  EXPECT_NE(resumed.output.find("resumed after frame"), std::string::npos) << resumed.output;
  expect_same_results(folder_ / "tracked", out);
}

}  // namespace
}  // namespace flowskin::end_to_end
