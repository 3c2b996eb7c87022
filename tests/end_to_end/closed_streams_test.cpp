// Terminals that are closed, streams that cannot be written, and signals: runs go on, and nothing is left behind.
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <thread>

#include "end_to_end/small_run.h"

namespace flowskin::end_to_end {
namespace {

namespace fs = std::filesystem;

class ClosedStreams : public SmallRunTest {
 protected:
  ClosedStreams() : SmallRunTest("closed_streams", {"--threads", "1"}, {.frames = 4, .interval = 100}) {}

  /// A folder with an ffmpeg that is none; the scene has pictures from now on.
  fs::path fake_ffmpeg(const std::string& script) const {
    std::string text = bytes(scene());
    text.replace(text.find("\"enabled\": false"), 16, "\"width\": 32, \"height\": 32, \"samples\": 1");
    std::ofstream(scene()) << text;
    const fs::path bin = folder_ / "bin";
    fs::create_directories(bin);
    std::ofstream(bin / "ffmpeg") << "#!/bin/bash\necho $$ > " << said().string() << ".new; mv " << said().string()
                                  << ".new " << said().string() << "\n"
                                  << script << "\n";
    fs::permissions(bin / "ffmpeg", fs::perms::owner_all);
    return bin;
  }
  /// Where it writes the number of its process.
  fs::path said() const { return folder_ / "said"; }
  /// A run that is waiting for it gets these signals, one after the other; `to` "-" is for all of its process group.
  Result run_during_ffmpeg(const fs::path& bin, const std::string& signals, const std::string& to) const {
    fs::remove(said());
    fs::remove_all(folder_ / "run");
    return shell("trap - INT; set -m; PATH=" + bin.string() + ":$PATH; " + run_line("run") +
                 " --frames 1 --quiet & child=$!; until [ -s " + said().string() +
                 " ]; do kill -0 $child || break; sleep 0.01; done; for s in " + signals + "; do kill -$s -- " + to +
                 "$child; sleep 0.1; done; wait $child");
  }

  /// By a shell, which puts the program in the place of $F.
  static Result shell(const std::string& line) {
    return run_program({"bash", "-c", "F=" FLOWSKIN_BINARY_DIR "/flowskin; " + line});
  }
  std::string run_line(const std::string& name) const {
    return "$F run " + scene().string() + " --threads 1 --out " + (folder_ / name).string();
  }
};

TEST_F(ClosedStreams, ARunGoesOnWithoutItsTerminal) {
  const fs::path straight = folder_ / "straight";
  ASSERT_EQ(run_flowskin(arguments(straight)).status, 0);
  const std::vector<std::string> ways{"2>/dev/full", "2>&-", ">&- 2>&-", "<&- >&- 2>&-", "2> >(exec true)"};
  for (std::size_t k = 0; k < ways.size(); ++k) {
    const std::string name = "run_" + std::to_string(k);
    const Result result = shell(run_line(name) + " " + ways[k]);
    EXPECT_EQ(result.status, 0) << ways[k] << ": " << result.output;
    expect_same_results(straight, folder_ / name);
    EXPECT_NE(bytes(folder_ / name / "log.txt").find("done: "), std::string::npos) << ways[k];
    EXPECT_EQ(bytes(folder_ / name / "log.txt").find("not complete"), std::string::npos) << ways[k];
  }
}

TEST_F(ClosedStreams, ErrorsKeepTheirStatus) {
  for (const char* way : {"2>/dev/full", "2>&-", ">/dev/full 2>&1"})
    EXPECT_EQ(shell(std::string("$F info nothing ") + way).status, 2) << way;
  EXPECT_EQ(shell("$F run nothing.json 2>/dev/full").status, 2);
  EXPECT_EQ(shell("$F run --wrong 2>/dev/full").status, 2);
}

TEST_F(ClosedStreams, ResultsThatCannotBeWrittenAreAFailure) {
  for (const std::string& command :
       std::vector<std::string>{"methods", "scene --keys", "scene --defaults", "info " + scene().string(), "--help",
                                "run --help", "--version", "validate --list"}) {
    const Result full = shell("$F " + command + " >/dev/full");
    EXPECT_EQ(full.status, 1) << command << ": " << full.output;
    EXPECT_NE(full.output.find("standard output: No space left on device"), std::string::npos) << full.output;
    EXPECT_EQ(shell("$F " + command + " >&-").status, 1) << command;
    EXPECT_EQ(shell("$F " + command + " >/dev/null").status, 0) << command;
  }
  const Result broken = shell("{ sleep 0.2; $F scene --keys; echo status $? >&2; } | true");
  EXPECT_NE(broken.output.find("Broken pipe"), std::string::npos) << broken.output;
  EXPECT_NE(broken.output.find("status 1"), std::string::npos) << broken.output;
}

TEST_F(ClosedStreams, AHangupSavesAndTheRunGoesOn) {
  small_.frames = 15;
  small_.write(scene());
  const fs::path straight = folder_ / "straight", out = folder_ / "run";
  ASSERT_EQ(run_flowskin(arguments(straight)).status, 0);
  int hangups = 0;
  const Result result =
      shell(run_line("run") + " --quiet & child=$!; " + "for k in 1 2 3; do until [ -e " + out.string() +
            "/surface/frame_000$k.ply ]; do kill -0 $child || break; kill -0 $child || break; sleep 0.005; done; kill "
            "-HUP $child; done; wait $child");
  EXPECT_EQ(result.status, 0) << result.output;
  expect_same_results(straight, out);
  const std::string log = bytes(out / "log.txt");
  for (std::size_t place = log.find("SIGHUP"); place != std::string::npos; place = log.find("SIGHUP", place + 1))
    ++hangups;
  EXPECT_GE(hangups, 1) << log;
}

TEST_F(ClosedStreams, WhatAHangupSavedCanBeResumed) {
  small_.frames = 15;
  small_.write(scene());
  const fs::path straight = folder_ / "straight", out = folder_ / "run";
  ASSERT_EQ(run_flowskin(arguments(straight)).status, 0);
  const Result killed = shell(run_line("run") + " --quiet & child=$!; until [ -e " + out.string() +
                              "/surface/frame_0002.ply ]; do kill -0 $child || break; kill -0 $child || break; sleep "
                              "0.005; done; kill -HUP $child; until ls " +
                              out.string() +
                              "/checkpoint/frame_*.bin >/dev/null 2>&1; do kill -0 $child || break; sleep 0.005; done; "
                              "kill -KILL $child; wait $child");
  EXPECT_EQ(killed.status, 128 + SIGKILL) << killed.output;
  ASSERT_GE(newest_checkpoint(out), 1);
  ASSERT_EQ(run_flowskin(arguments(out, {"--resume"})).status, 0);
  expect_same_results(straight, out);
}

TEST_F(ClosedStreams, AHangupStopsWhereThatIsAskedFor) {
  small_.frames = 60;
  small_.write(scene());
  const fs::path out = folder_ / "run";
  const Result result = run_flowskin_until(
      arguments(out, {"--quiet", "--stop-on-hangup"}), [&] { return fs::exists(out / "surface/frame_0001.ply"); },
      SIGHUP);
  EXPECT_EQ(result.status, 129) << result.output;
  EXPECT_GE(newest_checkpoint(out), 1);
}

/// Whether a process is there and not just waiting to be collected.
bool is_alive(const std::string& process) {
  const std::string status = bytes("/proc/" + process + "/stat");
  const std::size_t bracket = status.rfind(')');
  return bracket != std::string::npos && bracket + 2 < status.size() && status[bracket + 2] != 'Z';
}

TEST_F(ClosedStreams, SignalsLeaveNoFfmpegBehind) {
  const fs::path bin = fake_ffmpeg("exec sleep 100");
  for (const char* signals : {"TERM", "INT", "TERM TERM", "INT TERM", "TERM INT", "KILL"}) {
    const Result result = run_during_ffmpeg(bin, signals, "");
    const bool killed = result.status == 137;
    EXPECT_TRUE(result.status == 143 || result.status == 130 || killed) << signals << ": " << result.output;
    std::string process = bytes(said());
    process.erase(process.find_last_not_of("\n") + 1);
    for (int k = 0; k < 200 && is_alive(process); ++k) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_FALSE(is_alive(process)) << signals << ": ffmpeg " << process << " is still there";
    if (killed) continue;  // what it was writing is removed by the next run
    for (const std::string& name : files_below(folder_ / "run"))
      EXPECT_EQ(name.find(".part"), std::string::npos) << signals << ": " << name;
  }
}

TEST_F(ClosedStreams, AHangupDoesNotEndFfmpeg) {
  const fs::path bin = fake_ffmpeg("sleep 0.5; for last; do :; done; echo film > \"$last\"");
  const Result result = run_during_ffmpeg(bin, "HUP", "-");
  EXPECT_EQ(result.status, 0) << result.output;
  EXPECT_EQ(bytes(folder_ / "run/surface.mp4"), "film\n");
}

}  // namespace
}  // namespace flowskin::end_to_end
