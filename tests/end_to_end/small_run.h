// A scene that runs in a second and uses much of what a run can do, and comparing what runs wrote.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "end_to_end/program.h"

namespace flowskin::end_to_end {

/// A block of syrup falls into an open box beside a jet; texture generations, no pictures.
struct SmallScene {
  int frames = 12;
  int interval = 3;
  std::string simulation{};  ///< More keys of this section, each with a comma behind it.
  std::string more{};        ///< More keys of the scene, each with a comma before it.

  void write(const std::filesystem::path& file) const {
    std::ofstream(file.parent_path() / "box.obj")
        << "v 0 0 0\nv 0.5 0 0\nv 0.5 0 0.5\nv 0 0 0.5\nv 0 0.5 0\nv 0.5 0.5 0\nv 0.5 0.5 0.5\nv 0 0.5 0.5\n"
           "f 1 4 3 2\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    std::ofstream(file)
        << "{ \"name\": \"small\", \"frames\": " << frames
        << ", \"frame_rate\": 40,\n"
           "  \"particles\": { \"spacing\": 0.05 },\n"
           "  \"fluid\": { \"viscosity\": 0.01 },\n"
           "  \"simulation\": { "
        << simulation
        << "\"domain\": { \"min\": [-1, -1, -1], \"max\": [1, 2, 1] } },\n"
           "  \"bodies\": [ { \"shape\": \"block\", \"min\": [0.1, 0.1, 0.1], \"max\": [0.4, 0.4, 0.4], "
           "\"velocity\": [0.5, -2, 0] } ],\n"
           "  \"emitters\": [ { \"center\": [0.25, 0.7, 0.25], \"radius\": 0.09, \"speed\": 2, "
           "\"stop\": 0.2 } ],\n"
           "  \"boundaries\": [ { \"file\": \"box.obj\" } ],\n"
           "  \"texture\": { \"when_stretched\": \"fade\", \"stretch_limit\": 1.5 },\n"
           "  \"render\": { \"enabled\": false },\n"
           "  \"output\": { \"checkpoint_interval\": "
        << interval << " }" << more << " }\n";
  }
};

/// All files but the log, the record and the checkpoints are the same to the byte, but for the columns of seconds.
inline void expect_same_results(const std::filesystem::path& a, const std::filesystem::path& b) {
  const auto results = [](const std::filesystem::path& folder) {
    std::vector<std::string> names;
    for (const std::string& name : files_below(folder))
      if (name != "log.txt" && name != "flowskin_run.txt" && name.rfind("checkpoint/", 0) != 0) names.push_back(name);
    return names;
  };
  ASSERT_EQ(results(a), results(b));
  for (const std::string& name : results(a)) {
    if (name != "frames.csv" && name != "compare.csv") {
      EXPECT_TRUE(bytes(a / name) == bytes(b / name)) << name << " differs between " << a << " and " << b;
      continue;
    }
    const Table one(a / name), two(b / name);
    ASSERT_EQ(one.columns(), two.columns());
    for (const std::string& column : one.columns())
      if (column.rfind("seconds", 0) != 0) {
        EXPECT_EQ(one.text(column), two.text(column)) << name << ": " << column;
      }
  }
}

/// The frame of the newest checkpoint; -1 where there is none.
inline int newest_checkpoint(const std::filesystem::path& run) {
  int newest = -1;
  if (!std::filesystem::exists(run / "checkpoint")) return newest;
  for (const std::string& name : files_below(run / "checkpoint"))
    if (name.rfind("frame_", 0) == 0) newest = std::max(newest, std::stoi(name.substr(6)));
  return newest;
}

/// Tests that run the small scene in a folder of their own.
class SmallRunTest : public ::testing::Test {
 protected:
  /// @param always options of every run
  SmallRunTest(std::string name, std::vector<std::string> always, SmallScene small = {})
      : small_(std::move(small)), name_(std::move(name)), always_(std::move(always)) {}
  void SetUp() override {
    folder_ = fresh_folder(name_);
    small_.write(scene());
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path scene() const { return folder_ / "small.json"; }
  std::vector<std::string> arguments(const std::filesystem::path& out,
                                     const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all{"run", scene().string(), "--out", out.string()};
    all.insert(all.end(), always_.begin(), always_.end());
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  SmallScene small_;
  std::filesystem::path folder_;

 private:
  std::string name_;
  std::vector<std::string> always_;
};

}  // namespace flowskin::end_to_end
