// Checkpoints with other numbers in them and a right checksum: refused, or harmless. And what else a run is refused
// for.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <omp.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>

#include "common/errors.h"
#include "common/thread_count.h"
#include "scenes/io/atomic_file.h"
#include "scenes/io/checksum.h"
#include "scenes/io/read_bytes.h"
#include "scenes/scene_file.h"
#include "tools/pipeline/run_scene.h"

namespace flowskin::tools::altered_checkpoint_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class AlteredCheckpoints : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / fmt::format("flowskin_altered_{}", getpid());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  RunOptions options(const std::string& name, int frames) const {
    RunOptions options;
    options.out = folder_ / name;
    options.frames = frames;
    options.pictures = options.video = false;
    options.quiet = true;
    return options;
  }
  static scenes::Scene scene(const std::string& text) { return scenes::parse_scene(text, "test.json", "."); }

  /// Runs one frame, alters the checkpoint everywhere in turn, and goes on from each. @return how many were refused
  int go_on_from_altered(const std::string& text, std::size_t step) {
    run_scene(scene(text), options("whole", 1));
    const std::string bytes = scenes::read_bytes(folder_ / "whole/checkpoint/frame_0001.bin");
    int refused = 0;
    const std::size_t head = 24, size = bytes.size() - 20;
    for (std::size_t at = head; at + 8 <= size; at += step) {
      std::string altered = bytes;
      const std::uint64_t values[] = {0, 2, std::uint64_t{1} << 33, ~std::uint64_t{0}};
      std::memcpy(altered.data() + at, &values[at / step % 4], 8);
      const std::uint32_t sum = scenes::checksum(0, std::string_view(altered).substr(0, size));
      std::memcpy(altered.data() + size + 8, &sum, sizeof sum);
      fs::remove_all(folder_ / "again");
      fs::copy(folder_ / "whole", folder_ / "again", fs::copy_options::recursive);
      scenes::write_file(folder_ / "again/checkpoint/frame_0001.bin", altered);
      RunOptions again = options("again", 2);
      again.resume = true;
      try {
        run_scene(scene(text), again);
      } catch (const InputError&) {
        ++refused;
      } catch (const RunError&) {
      }
    }
    return refused;
  }

  fs::path folder_;
};

TEST_F(AlteredCheckpoints, OfASimulationAreRefusedOrHarmless) {
  EXPECT_GT(go_on_from_altered(R"({
    "frame_rate": 100, "particles": {"spacing": 0.05}, "simulation": {"max_speed": 2},
    "bodies": [{"shape": "block", "min": [0, 0, 0], "max": [0.1, 0.15, 0.1]}],
    "texture": {"when_stretched": "fade"}, "output": {"checkpoint_interval": 1}})",
                               516),
            4);
}

TEST_F(AlteredCheckpoints, OfPrescribedMotionAreRefusedOrHarmless) {
  EXPECT_GT(go_on_from_altered(R"({
    "frame_rate": 100, "particles": {"spacing": 0.05, "source": "prescribed", "motion": {"type": "vortex"}},
    "bodies": [{"shape": "block", "min": [0, 0, 0], "max": [0.1, 0.15, 0.1]}],
    "output": {"checkpoint_interval": 1}})",
                               516),
            4);
}

TEST_F(AlteredCheckpoints, ASceneMayHaveNoFramesButTheFirst) {
  const std::string text = R"({
    "frames": 0, "particles": {"spacing": 0.05}, "simulation": {"max_speed": 2},
    "bodies": [{"shape": "block", "min": [0, 0, 0], "max": [0.1, 0.15, 0.1]}]})";
  RunOptions run = options("none", 0);
  run.frames.reset();
  run_scene(scene(text), run);
  EXPECT_TRUE(fs::exists(folder_ / "none/surface/frame_0000.ply"));
  EXPECT_FALSE(fs::exists(folder_ / "none/surface/frame_0001.ply"));
  // The scene that is written can be read again.
  EXPECT_EQ(scenes::read_scene(folder_ / "none/scene.json").frames, 0);
}

TEST_F(AlteredCheckpoints, WhatIsWrongAtTheStartIsTheInputs) {
  const auto error = [&](const std::string& text) {
    try {
      run_scene(scene(text), options("wrong", 1));
    } catch (const InputError& input) {
      return std::string(input.what());
    } catch (const sph::SettingsError& input) {
      return std::string(input.what());
    }
    return std::string("no error");
  };
  const std::string start = R"({"particles": {"spacing": 0.05)", body = R"(, "bodies": [{"shape": "block", "min": )";
  EXPECT_THAT(error(start + "}" + body + R"([0, 0, 0], "max": [0.1, 0.1, 0.1], "velocity": [900, 0, 0]}],
                    "simulation": {"max_speed": 1}})"),
              HasSubstr("speed of sound"));
  EXPECT_THAT(error(start + R"(, "source": "prescribed", "motion": {"type": "translation"}})" + body +
                    "[999999, 0, 0], \"max\": [999999.1, 0.1, 0.1]}]}"),
              HasSubstr("too far away"));
  EXPECT_FALSE(fs::exists(folder_ / "wrong/surface/frame_0000.ply"));
}

TEST(ThreadCount, IsLimitedHoweverManyAreAskedFor) {
  const int before = omp_get_max_threads();
  use_threads(100000);
  EXPECT_EQ(omp_get_max_threads(), most_threads());
  omp_set_num_threads(100000);  // as OMP_NUM_THREADS does
  use_threads(0);
  EXPECT_EQ(omp_get_max_threads(), most_threads());
  use_threads(3);
  EXPECT_EQ(omp_get_max_threads(), 3);
  omp_set_num_threads(before);
}

}  // namespace
}  // namespace flowskin::tools::altered_checkpoint_test
