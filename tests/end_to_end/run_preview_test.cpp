// The preview scene from the built program to the files on disk, each read by a reader that is not ours.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "end_to_end/program.h"
#include "tiny_obj_loader.h"

namespace flowskin {
namespace {

namespace fs = std::filesystem;
using end_to_end::Table;

/// Runs the preview once for all tests of this file, with one and with two threads.
class PreviewRun : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = end_to_end::fresh_folder("preview");
    for (const char* threads : {"1", "2"}) {
      const auto result = end_to_end::run_flowskin({"run", end_to_end::scene("stairs_preview.json"), "--out",
                                                    (folder_ / threads).string(), "--threads", threads, "--quiet"});
      ASSERT_EQ(result.status, 0) << result.output;
    }
    scene_ = nlohmann::json::parse(std::ifstream(run() / "scene.json"), nullptr, true, true);
    frames_ = scene_["frames"].get<int>() + 1;
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }

  static fs::path run() { return folder_ / "2"; }
  static fs::path folder_;
  static nlohmann::json scene_;
  static int frames_;
};

fs::path PreviewRun::folder_;
nlohmann::json PreviewRun::scene_;
int PreviewRun::frames_ = 0;

TEST_F(PreviewRun, SameBytesAtOneAndTwoThreads) {
  const auto names = end_to_end::files_below(folder_ / "1");
  ASSERT_EQ(names, end_to_end::files_below(folder_ / "2"));
  ASSERT_GT(names.size(), std::size_t(frames_) * 6);
  for (const std::string& name : names) {
    // These tell when things were written and how long that took.
    if (name == "log.txt" || name == "flowskin_run.txt" || name == "frames.csv" || name.starts_with("checkpoint/"))
      continue;
    EXPECT_TRUE(end_to_end::bytes(folder_ / "1" / name) == end_to_end::bytes(folder_ / "2" / name)) << name;
  }
  const Table one(folder_ / "1" / "frames.csv"), two(folder_ / "2" / "frames.csv");
  for (const std::string& column : one.columns())
    if (column.rfind("seconds_", 0) != 0) {
      EXPECT_EQ(one.text(column), two.text(column)) << column;
    }
}

TEST_F(PreviewRun, EveryFrameIsThere) {
  for (int frame = 0; frame < frames_; ++frame) {
    char name[32];
    std::snprintf(name, sizeof name, "frame_%04d", frame);
    for (const char* extension : {".obj", ".ply", ".vtp"})
      EXPECT_TRUE(fs::exists(run() / "surface" / (std::string(name) + extension))) << name << extension;
    for (const char* extension : {".ply", ".vtp"})
      EXPECT_TRUE(fs::exists(run() / "particles" / (std::string(name) + extension))) << name << extension;
    EXPECT_TRUE(fs::exists(run() / "images" / (std::string(name) + ".png"))) << name;
  }
  for (const char* name : {"contact_sheet.png", "log.txt", "surface/texture.png", "surface/surface.mtl",
                           "surface/surface.pvd", "particles/particles.pvd"})
    EXPECT_TRUE(fs::exists(run() / name)) << name;
  for (const std::string& name : end_to_end::files_below(run()))
    EXPECT_EQ(name.find(".part"), std::string::npos) << "left behind: " << name;
}

TEST_F(PreviewRun, SurfacesAreClosedTwoManifoldAndOutwardForTinyObjLoader) {
  for (int frame = 0; frame < frames_; ++frame) {
    char name[32];
    std::snprintf(name, sizeof name, "frame_%04d.obj", frame);
    tinyobj::ObjReader reader;
    ASSERT_TRUE(reader.ParseFromFile((run() / "surface" / name).string())) << name << reader.Error();
    EXPECT_TRUE(reader.Warning().empty()) << reader.Warning();
    ASSERT_EQ(reader.GetMaterials().size(), 1u);
    EXPECT_EQ(reader.GetMaterials()[0].diffuse_texname, "texture.png");
    const auto& attributes = reader.GetAttrib();
    std::map<std::pair<int, int>, int> half_edges;
    std::set<int> used;
    double volume = 0;
    for (const auto& shape : reader.GetShapes()) {
      const auto& corners = shape.mesh.indices;
      for (std::size_t c = 0; c + 2 < corners.size(); c += 3) {
        Eigen::Matrix3d triangle;
        for (int k = 0; k < 3; ++k) {
          const auto corner = corners[c + std::size_t(k)];
          ASSERT_GE(corner.texcoord_index, 0);
          ASSERT_GE(corner.normal_index, 0);
          used.insert(corner.vertex_index);
          ++half_edges[{corner.vertex_index, corners[c + std::size_t((k + 1) % 3)].vertex_index}];
          for (int axis = 0; axis < 3; ++axis)
            triangle(axis, k) = attributes.vertices[3 * std::size_t(corner.vertex_index) + std::size_t(axis)];
        }
        volume += triangle.determinant() / 6;
      }
    }
    for (const auto& [edge, count] : half_edges) {
      ASSERT_EQ(count, 1) << name << ": an edge is passed twice in the same direction";
      ASSERT_TRUE(half_edges.contains({edge.second, edge.first})) << name << ": an edge has one side only";
    }
    EXPECT_EQ(used.size() * 3, attributes.vertices.size()) << name << ": unreferenced vertices";
    EXPECT_GT(volume, 0) << name;
  }
}

TEST_F(PreviewRun, FramesKeepTheirPromises) {
  const Table table(run() / "frames.csv");
  const double spacing = scene_["particles"]["spacing"], radius = scene_["tracking"]["radius"];
  ASSERT_EQ(table.rows(), std::size_t(frames_));
  for (std::size_t row = 0; row < table.rows(); ++row) {
    EXPECT_NEAR(table.number("volume", row), table.number("expected_volume", row),
                0.02 * table.number("expected_volume", row))
        << "frame " << row;
    EXPECT_LT(table.number("max_distance", row), 1e-3 * radius * spacing) << "frame " << row;
    EXPECT_EQ(table.number("left_domain", row), 0) << "frame " << row;
    EXPECT_GT(table.number("particles", row), 1000) << "frame " << row;
  }
}

TEST_F(PreviewRun, FluidFlowsDown) {
  const Table table(run() / "frames.csv");
  EXPECT_LT(table.number("potential_energy", table.rows() - 1), 0.8 * table.number("potential_energy", 0));
}

TEST_F(PreviewRun, PicturesAndVideosAreValidForFfprobe) {
  if (!end_to_end::have_program("ffprobe")) GTEST_SKIP() << "ffprobe is not installed";
  const std::string size = std::to_string(scene_["render"]["width"].get<int>()) + "," +
                           std::to_string(scene_["render"]["height"].get<int>());
  for (const char* file : {"images/frame_0000.png", "images/particles_0000.png"})
    EXPECT_EQ(end_to_end::ffprobe(run() / file, "width,height"), size) << file;
  for (const char* file : {"surface.mp4", "particles.mp4"}) {
    EXPECT_EQ(end_to_end::ffprobe(run() / file, "width,height"), size) << file;
    EXPECT_EQ(end_to_end::ffprobe(run() / file, "nb_read_frames"), std::to_string(frames_)) << file;
  }
}

TEST_F(PreviewRun, RenderMakesThePicturesAgainInAnotherSize) {
  const fs::path copy = folder_ / "copy";
  fs::copy(run(), copy, fs::copy_options::recursive);
  const auto result = end_to_end::run_flowskin(
      {"render", copy.string(), "--width", "160", "--height", "96", "--style", "normals", "--quiet"});
  ASSERT_EQ(result.status, 0) << result.output;
  if (!end_to_end::have_program("ffprobe")) GTEST_SKIP() << "ffprobe is not installed";
  EXPECT_EQ(end_to_end::ffprobe(copy / "images/frame_0003.png", "width,height"), "160,96");
  EXPECT_EQ(end_to_end::ffprobe(copy / "surface.mp4", "width,height"), "160,96");
}

TEST_F(PreviewRun, RenderAgainWithTheSameSettingsMakesTheSamePicture) {
  const fs::path copy = folder_ / "same";
  fs::copy(run(), copy, fs::copy_options::recursive);
  ASSERT_EQ(end_to_end::run_flowskin({"render", copy.string(), "--quiet", "--no-video"}).status, 0);
  // The run draws from double precision, render from the float of the files: pictures agree but for rounding.
  EXPECT_LT(end_to_end::mean_pixel_difference(run() / "images/frame_0010.png", copy / "images/frame_0010.png"), 1.0);
}

TEST_F(PreviewRun, InfoCallsEveryFileSound) {
  const auto result = end_to_end::run_flowskin(
      {"info", (run() / "surface/frame_0005.obj").string(), (run() / "surface/frame_0005.ply").string(),
       (run() / "particles/frame_0005.ply").string(), (run() / "scene.json").string()});
  EXPECT_EQ(result.status, 0) << result.output;
}

TEST_F(PreviewRun, TheSceneAsRunRunsAgain) {
  const auto result = end_to_end::run_flowskin(
      {"run", (run() / "scene.json").string(), "--out", (folder_ / "again").string(), "--frames", "2", "--quiet"});
  ASSERT_EQ(result.status, 0) << result.output;
  EXPECT_TRUE(end_to_end::bytes(run() / "surface/frame_0002.ply") ==
              end_to_end::bytes(folder_ / "again/surface/frame_0002.ply"));
}

}  // namespace
}  // namespace flowskin
