// Checkpoint files, what may change before a run is resumed, and the table of computing time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "common/errors.h"
#include "scenes/io/atomic_file.h"
#include "scenes/scene_file.h"
#include "tools/pipeline/checkpoint.h"
#include "tools/pipeline/comparison_pictures.h"
#include "tools/pipeline/input_files.h"
#include "tools/pipeline/resume.h"
#include "tools/report/run_log.h"
#include "tools/report/time_table.h"

namespace flowskin::tools::checkpoint_test {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Checkpoints : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("flowskin_checkpoints_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  static CheckpointHeader header(int frame) {
    return {version_text(), "{\"frames\": 3}", {{"a", "a.obj", 1}}, "", frame};
  }
  static void save(const CheckpointFolder& folder, int frame) {
    folder.save(header(frame), [&](StateWriter& writer) { writer(frame, std::string(3000000, 'x')); });
  }
  std::size_t count() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator{}));
  }

  fs::path folder_;
};

TEST_F(Checkpoints, ComeBack) {
  const CheckpointFolder folder(folder_);
  save(folder, 7);
  Checkpoint checkpoint(*folder.newest());
  EXPECT_EQ(checkpoint.header().frame, 7);
  EXPECT_EQ(checkpoint.header().scene, "{\"frames\": 3}");
  int frame = 0;
  std::string text;
  checkpoint.state()(frame, text);
  EXPECT_EQ(frame, 7);
  EXPECT_EQ(text, std::string(3000000, 'x'));
  EXPECT_EQ(checkpoint.state().bytes_left(), 0U);
}

TEST_F(Checkpoints, TheTwoNewestAreKept) {
  const CheckpointFolder folder(folder_);
  EXPECT_FALSE(folder.newest().has_value());
  for (const int frame : {0, 90, 100, 100, 110}) save(folder, frame);
  EXPECT_EQ(folder.newest()->filename(), "frame_0110.bin");
  EXPECT_EQ(count(), 2U);
  EXPECT_EQ(folder.complete_frames(), -1);
  folder.mark_complete(110);
  EXPECT_EQ(folder.complete_frames(), 110);
  EXPECT_EQ(count(), 2U);  // one and the note
  folder.unmark_complete();
  EXPECT_EQ(folder.complete_frames(), -1);
}

TEST_F(Checkpoints, AreNotResumedWithOtherFiles) {
  save(CheckpointFolder(folder_), 1);
  const Checkpoint checkpoint(folder_ / "frame_0001.bin");
  CheckpointHeader now = header(1);
  now.files[0].file = "elsewhere/a.obj";
  EXPECT_THAT(check_resumable(checkpoint, now, 3), ElementsAre());
  now.files[0].checksum = 2;
  try {
    check_resumable(checkpoint, now, 3);
    FAIL() << "must throw";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("a (what is in the file elsewhere/a.obj)"));
    EXPECT_THAT(error.what(), HasSubstr("or run the scene anew"));
  }
}

TEST_F(Checkpoints, AnUnfinishedOneIsNotThere) {
  const CheckpointFolder folder(folder_);
  save(folder, 1);
  EXPECT_THROW(folder.save(header(2), [](StateWriter&) { throw RunError("no space"); }), RunError);
  EXPECT_EQ(folder.newest()->filename(), "frame_0001.bin");
  EXPECT_EQ(count(), 1U);
}

TEST_F(Checkpoints, OfAnotherVersionAreRefused) {
  CheckpointHeader other = header(3);
  other.program = "flowskin 99.0";
  CheckpointFolder(folder_).save(other, [](StateWriter&) {});
  try {
    Checkpoint checkpoint(folder_ / "frame_0003.bin");
    FAIL() << "must throw";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("flowskin 99.0"));
    EXPECT_THAT(error.what(), HasSubstr("frame_0003.bin"));
  }
}

TEST_F(Checkpoints, DraftsAreRemovedInASignalHandler) {
  scenes::AtomicFile file(folder_ / "a.bin");
  file.write("half");
  EXPECT_EQ(count(), 1U);
  scenes::remove_drafts();
  EXPECT_EQ(count(), 0U);
}

TEST_F(Checkpoints, StaleDraftsAreRemoved) {
  std::ofstream(folder_ / ".frame_0001.ply.123-4.part") << "half";
  std::ofstream(folder_ / ".surface.mp4.99-0.part") << "half";
  std::ofstream(folder_ / "mine.part") << "whole";
  scenes::remove_stale_drafts(folder_);
  EXPECT_EQ(count(), 1U);
  EXPECT_TRUE(fs::exists(folder_ / "mine.part"));
}

TEST(InputFiles, EveryMeshAndTheTextureCount) {
  scenes::Scene scene;
  const sph::TriangleMesh triangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  scene.bodies.emplace_back().body.mesh = scene.boundaries.emplace_back().boundary.mesh = triangle;
  scene.emitters.emplace_back().emitter.mesh = scene.sinks.emplace_back().sink.mesh = triangle;
  Image texture{2, 1, {Color{1, 2, 3}, Color{4, 5, 6}}};
  const auto files_then = input_files(scene, texture);
  const auto changed = [&] {
    const auto now = input_files(scene, texture);
    EXPECT_EQ(now.size(), files_then.size());
    std::vector<std::string> keys;
    for (std::size_t k = 0; k < now.size(); ++k)
      if (now[k] != files_then[k]) keys.push_back(now[k].key);
    return keys;
  };
  EXPECT_THAT(changed(), ElementsAre());
  const auto changed_with = [&](sph::TriangleMesh& mesh) {
    mesh.positions[2].y() = 1.5;
    const auto keys = changed();
    mesh = triangle;
    return keys;
  };
  EXPECT_THAT(changed_with(scene.bodies[0].body.mesh), ElementsAre("bodies[0].file"));
  EXPECT_THAT(changed_with(scene.emitters[0].emitter.mesh), ElementsAre("emitters[0].file"));
  EXPECT_THAT(changed_with(scene.sinks[0].sink.mesh), ElementsAre("sinks[0].file"));
  EXPECT_THAT(changed_with(scene.boundaries[0].boundary.mesh), ElementsAre("boundaries[0].file"));
  texture.pixels[1] = {4, 5, 7};
  EXPECT_THAT(changed(), ElementsAre("texture.image"));
}

TEST(SceneChanges, NamesTheKeysThatDiffer) {
  scenes::Scene scene;
  scene.particles.spacing = 0.1;
  scene.bodies.emplace_back();
  const std::string then = scenes::write_scene(scene);
  EXPECT_TRUE(scene_changes(then, then).forbidden.empty());

  scenes::Scene other = scene;
  other.solver.viscosity = 3;
  other.bodies[0].body.velocity = {1, 2, 3};
  other.emitters.emplace_back();
  std::vector<std::string> keys = scene_changes(then, scenes::write_scene(other)).forbidden;
  EXPECT_THAT(keys, ::testing::Contains("fluid.viscosity"));
  EXPECT_THAT(keys, ::testing::Contains("bodies[0].velocity"));
  EXPECT_THAT(keys, ::testing::Contains("emitters[0].radius"));
  // The other way round a list is gone.
  EXPECT_FALSE(scene_changes(scenes::write_scene(other), then).forbidden.empty());
}

TEST(SceneChanges, WhatThePastDoesNotDependOnIsFree) {
  scenes::Scene scene;
  scene.boundaries.emplace_back();
  scenes::Scene other = scene;
  other.name = "another";
  other.frames = 1000;
  other.render.width = 100;
  other.render.camera.position = {1, 2, 3};
  other.output.checkpoint_interval = 1;
  other.boundaries[0].visible = false;
  other.boundaries[0].mesh.file = "elsewhere.obj";
  const SceneChanges changes = scene_changes(scenes::write_scene(scene), scenes::write_scene(other));
  EXPECT_THAT(changes.forbidden, ElementsAre());
  EXPECT_THAT(changes.numerical, ElementsAre());
}

TEST(SceneChanges, NumericalLimitsAreAllowedAndTold) {
  scenes::Scene scene, other;
  other.solver.max_speed = 4;
  other.solver.acoustic_cfl = 0.2;
  const SceneChanges changes = scene_changes(scenes::write_scene(scene), scenes::write_scene(other));
  EXPECT_THAT(changes.forbidden, ElementsAre());
  EXPECT_THAT(changes.numerical,
              ElementsAre("simulation.max_speed: 0, now 4", "simulation.acoustic_cfl: 0.4, now 0.2"));
}

TEST(CutTiles, GivesBackWhatWasPutTogether) {
  std::vector<Image> tiles;
  for (int k = 0; k < 5; ++k) {
    Image& tile = tiles.emplace_back();
    tile.width = 64;
    tile.height = 36;
    for (int i = 0; i < 64 * 36; ++i)
      tile.pixels.push_back({std::uint8_t(i % 251), std::uint8_t(k * 40), std::uint8_t(i / 64)});
  }
  const Image sheet = label_tiles(tiles, {"a", "b", "c", "d", "e"});
  const std::vector<Image> again = cut_tiles(sheet, 5, 64, 36);
  ASSERT_EQ(again.size(), 5U);
  for (std::size_t k = 0; k < 5; ++k) EXPECT_TRUE(again[k].pixels == tiles[k].pixels) << k;
  EXPECT_TRUE(cut_tiles(sheet, 5, 62, 36).empty());
}

TEST(TimeTable, PartsSharesAndSecondsASimulatedSecond) {
  const std::vector<std::string> lines =
      time_table({{"source", 6, {{"neighbours", 2}, {"forces", 3}}}, {"tracking", 3}}, 2, 10);
  ASSERT_EQ(lines.size(), 9U);
  const auto line = [&](std::size_t k) {
    std::string text;
    for (const char c : lines[k])
      if (c != ' ' || (!text.empty() && text.back() != ' ')) text += c;
    return text;
  };
  EXPECT_EQ(line(1), "source 6.00 s 3.000 s 60.0 %");
  EXPECT_EQ(line(2), "neighbours 2.00 s 1.000 s 20.0 %");
  EXPECT_EQ(line(4), "other 1.00 s 0.500 s 10.0 %");
  EXPECT_EQ(line(5), "tracking 3.00 s 1.500 s 30.0 %");
  EXPECT_EQ(line(6), "other 1.00 s 0.500 s 10.0 %");
  EXPECT_EQ(line(7), "in all 10.00 s 5.000 s 100.0 %");
  EXPECT_THAT(lines[8], HasSubstr("of the 2 s"));
  EXPECT_EQ(time_table({{"source", 6}}, 0, 6).size(), 3U);
}

}  // namespace
}  // namespace flowskin::tools::checkpoint_test
