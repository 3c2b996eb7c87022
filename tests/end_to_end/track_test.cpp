// `flowskin track` on the particles of a run of this program: the same surface comes out as from the run itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "common/closest_point.h"
#include "end_to_end/program.h"
#include "scenes/io/frame_files.h"
#include "scenes/io/ply_reader.h"
#include "tracking/mesh/mesh_check.h"

namespace flowskin {
namespace {

namespace fs = std::filesystem;
using end_to_end::run_flowskin;

constexpr int kFrames = 6;
constexpr double kSpacing = 0.05;

/// A body that turns and flies, run once; its particles are then tracked in several ways.
class TrackCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = end_to_end::fresh_folder("track");
    std::ofstream(folder_ / "scene.json") << R"({
      "frames": 6, "frame_rate": 20, "particles": {"source": "prescribed", "spacing": 0.05, "jitter": 0.1,
      "motion": {"type": "rotation", "angular_velocity": [0.2, 1.5, 0.4], "velocity": [0.6, 0.3, 0]}},
      "bodies": [{"shape": "block", "min": [-0.3, 0.1, -0.2], "max": [0.3, 0.4, 0.2]}],
      "tracking": {"steps_per_frame": 1}})";
    const auto run = run_flowskin(
        {"run", (folder_ / "scene.json").string(), "--out", (folder_ / "run").string(), "--no-pictures", "--quiet"});
    ASSERT_EQ(run.status, 0) << run.output;
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }

  static tracking::SurfaceMesh surface(const std::string& run, int frame) {
    return scenes::read_surface_ply(folder_ / run / "surface" / ("frame_000" + std::to_string(frame) + ".ply"));
  }

  /// Tracks and checks that every frame is there and sound.
  static std::string track(const std::string& out, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "track");
    for (const std::string& more : {std::string("--out"), (folder_ / out).string(), std::string("--no-pictures")})
      arguments.push_back(more);
    const auto result = run_flowskin(arguments);
    EXPECT_EQ(result.status, 0) << result.output;
    for (int frame = 0; frame <= kFrames; ++frame) EXPECT_TRUE(tracking::mesh_problems(surface(out, frame)).empty());
    EXPECT_FALSE(fs::exists(folder_ / out / "surface" / "frame_0007.ply"));
    return result.output;
  }

  /// Largest distance of a vertex from the other surface (m).
  static double distance(const tracking::SurfaceMesh& from, const tracking::SurfaceMesh& to) {
    const ClosestPointTree tree(to.positions, to.triangles);
    double largest = 0;
    for (const auto& x : from.positions) {
      const MeshPoint point = tree.closest(x, 10);
      largest = std::max(largest, point.triangle < 0 ? std::numeric_limits<double>::infinity() : point.distance);
    }
    return largest;
  }

  /// As CSV, without what the flags leave out, in an order that changes from file to file.
  static void write_csv(const std::string& folder, bool velocities) {
    fs::create_directories(folder_ / folder);
    for (int frame = 0; frame <= kFrames; ++frame) {
      const auto name = "frame_000" + std::to_string(frame);
      const scenes::ParticleState state = scenes::particles_from_ply(folder_ / "run" / "particles" / (name + ".ply"));
      std::ofstream csv(folder_ / folder / (name + ".csv"));
      csv.precision(17);
      csv << (velocities ? "x,y,z,vx,vy,vz\n" : "x,y,z\n");
      const std::size_t count = state.positions.size();
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t p = (i * 7919 + 101 * static_cast<std::size_t>(frame)) % count;
        const auto &x = state.positions[p], &v = state.velocities[p];
        csv << x.x() << "," << x.y() << "," << x.z();
        if (velocities) csv << "," << v.x() << "," << v.y() << "," << v.z();
        csv << "\n";
      }
    }
  }

  static fs::path folder_;
};

fs::path TrackCommand::folder_;

TEST_F(TrackCommand, GivesTheSurfaceOfTheRun) {
  for (const std::string kind : {"ply", "vtp"}) {
    // The PLY files tell the radius; by distances alone the jittered particles seem a little denser or less dense.
    std::vector<std::string> arguments{(folder_ / "run" / "particles" / ("*." + kind)).string()};
    if (kind == "vtp") arguments.insert(arguments.end(), {"--spacing", "0.05"});
    const std::string said = track(kind, arguments);
    EXPECT_NE(said.find("7 files"), std::string::npos) << said;
    EXPECT_NE(said.find("effective radius 0.125 m"), std::string::npos) << said;
    for (int frame = 0; frame <= kFrames; ++frame) {
      const auto ours = surface(kind, frame), wanted = surface("run", frame);
      // Single precision of the files is all that differs, but it may decide about a flip of an edge: then a vertex of
      // one mesh is above an edge of the other by the edge's sag, e^2 / (8 r) = 0.07 spacings for an edge of 0.75
      // spacings on a bump of radius one spacing.
      EXPECT_NEAR(double(ours.positions.size()), double(wanted.positions.size()),
                  0.02 * double(wanted.positions.size()));
      EXPECT_LT(distance(ours, wanted), 0.07 * kSpacing) << frame;
      EXPECT_LT(distance(wanted, ours), 0.07 * kSpacing) << frame;
    }
  }
}

TEST_F(TrackCommand, EstimatesTheSpacing) {
  const std::string said = track("estimated", {(folder_ / "run" / "particles" / "*.vtp").string()});
  const std::size_t place = said.find("spacing: ");
  ASSERT_NE(place, std::string::npos) << said;
  EXPECT_NEAR(std::stod(said.substr(place + 9)), kSpacing, 0.1 * kSpacing) << said;
}

TEST_F(TrackCommand, TheSceneInTheRunDirectoryRepeatsIt) {
  track("first", {(folder_ / "run" / "particles" / "particles.pvd").string(), "--spacing", "0.05"});
  const auto again = run_flowskin({"run", (folder_ / "first" / "scene.json").string(), "--out",
                                   (folder_ / "second").string(), "--no-pictures", "--quiet"});
  ASSERT_EQ(again.status, 0) << again.output;
  for (int frame = 0; frame <= kFrames; ++frame) {
    const std::string name = "surface/frame_000" + std::to_string(frame) + ".ply";
    EXPECT_EQ(end_to_end::bytes(folder_ / "first" / name), end_to_end::bytes(folder_ / "second" / name));
  }
}

TEST_F(TrackCommand, WorksWithoutIdsAndVelocities) {
  write_csv("shuffled", true);
  write_csv("bare", false);
  const std::string with_velocities =
      track("with", {(folder_ / "shuffled").string(), "--frame-rate", "20", "--spacing", "0.05"});
  EXPECT_NE(with_velocities.find("it is not known which is which"), std::string::npos) << with_velocities;
  track("without", {(folder_ / "bare").string(), "--time-step", "0.05", "--spacing", "0.05"});
  // The shape is that of the particles either way.
  for (const char* out : {"with", "without"}) {
    EXPECT_LT(distance(surface(out, kFrames), surface("run", kFrames)), 0.2 * kSpacing) << out;
    EXPECT_LT(distance(surface("run", kFrames), surface(out, kFrames)), 0.2 * kSpacing) << out;
  }
}

TEST_F(TrackCommand, ASingleFileIsOneSurface) {
  const auto result = run_flowskin({"track", (folder_ / "run/particles/frame_0000.ply").string(), "--out",
                                    (folder_ / "one").string(), "--no-pictures"});
  EXPECT_EQ(result.status, 0) << result.output;
  EXPECT_NE(result.output.find("a single frame"), std::string::npos) << result.output;
  EXPECT_TRUE(fs::exists(folder_ / "one/surface/frame_0000.ply"));
  EXPECT_FALSE(fs::exists(folder_ / "one/surface/frame_0001.ply"));
}

TEST_F(TrackCommand, SaysWhatIsWrong) {
  const auto expect_error = [](const std::vector<std::string>& arguments, const std::string& words) {
    const auto result = run_flowskin(arguments);
    EXPECT_EQ(result.status, 2) << result.output;
    EXPECT_NE(result.output.find(words), std::string::npos) << result.output;
  };
  const std::string particles = (folder_ / "run" / "particles").string();
  expect_error({"track"}, "particles");
  expect_error({"track", particles}, "name one kind");
  expect_error({"track", particles + "/nothing_*.ply"}, "no file matches");
  expect_error({"track", particles + "/*.ply", "--out", (folder_ / "run").string()}, "give another folder");
  expect_error({"track", particles + "/*.ply", "--radius", "-1"}, "--radius");
  expect_error({"track", particles + "/*.ply", "--radius", "9"}, "--radius and --spacing set it");
  expect_error({"track", (folder_ / "run" / "surface" / "*.ply").string()}, "not particles");
}

}  // namespace
}  // namespace flowskin
