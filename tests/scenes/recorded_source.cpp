// Recorded sequences: written by the test itself as ascii PLY, read back, interpolated.
#include "scenes/sources/recorded_source.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "scene_file_helpers.h"
#include "scenes/sources/file_pattern.h"
#include "scenes/sources/make_source.h"

namespace flowskin::scenes {
namespace {

using testing::AllOf;
using testing::HasSubstr;

struct TestParticle {
  std::uint64_t id;
  Vec3 position;
  Vec3 velocity = Vec3::Zero();
};

enum Columns { positions_only = 0, with_ids = 1, with_velocities = 2, with_rest = 4 };

/// A folder that is there for the time of one test.
class RecordedSourceTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) / (std::string("flowskin_recorded_") + test->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, const std::vector<TestParticle>& particles, int columns) const {
    std::string text = fmt::format("ply\nformat ascii 1.0\nelement vertex {}\n", particles.size());
    const auto declare = [&](const std::string& prefix) {
      for (const char axis : {'x', 'y', 'z'}) text += fmt::format("property double {}{}\n", prefix, axis);
    };
    const auto number = [&](const Vec3& v) { text += fmt::format("{} {} {} ", v.x(), v.y(), v.z()); };
    declare("");
    if (columns & with_velocities) declare("v");
    if (columns & with_rest) declare("rest_");
    if (columns & with_ids) text += "property uint id\n";
    text += "end_header\n";
    for (const TestParticle& p : particles) {
      number(p.position);
      if (columns & with_velocities) number(p.velocity);
      if (columns & with_rest) number(Vec3(p.position + Vec3(100, 0, 0)));
      if (columns & with_ids) text += std::to_string(p.id);
      text += "\n";
    }
    std::ofstream(folder_ / name) << text;
  }

  std::unique_ptr<ParticleSource> open(const std::string& pattern, double interval = 0.5) const {
    Scene scene;
    scene.directory = folder_.string();
    scene.particles.source = ParticlesSpec::Source::recorded;
    scene.particles.spacing = 0.1;
    scene.particles.recorded = {pattern, interval};
    return make_source(scene);
  }

  std::string error_of_pattern(const std::string& pattern) const {
    try {
      open(pattern);
    } catch (const SceneError& error) {
      return error.what();
    }
    return "no error";
  }

  std::filesystem::path folder_;
};

/// A cubic path, which Hermite interpolation must reproduce exactly.
Vec3 cubic(std::uint64_t id, double t) {
  const double a = static_cast<double>(id);
  return {a + t - 2 * t * t * t, 3 * t * t - a * t, 0.5 + t * t * t};
}
Vec3 cubic_velocity(std::uint64_t id, double t) { return {1 - 6 * t * t, 6 * t - static_cast<double>(id), 3 * t * t}; }

std::vector<TestParticle> cubic_particles(const std::vector<std::uint64_t>& ids, double t) {
  std::vector<TestParticle> particles;
  for (const std::uint64_t id : ids) particles.push_back({id, cubic(id, t), cubic_velocity(id, t)});
  return particles;
}

TEST_F(RecordedSourceTest, InterpolatesByIdWithCubicHermiteCurves) {
  // The order in the files changes; ids tell who is who.
  write("f_9.ply", cubic_particles({7, 3, 5}, 0), with_ids | with_velocities | with_rest);
  write("f_10.ply", cubic_particles({3, 5, 7}, 0.5), with_ids | with_velocities | with_rest);
  write("f_11.ply", cubic_particles({5, 7, 3}, 1), with_ids | with_velocities | with_rest);
  const auto source = open("f_*.ply");
  for (const double time : {0.0, 0.1, 0.5, 0.8, 1.0}) {
    source->advance_to(time);
    const ParticleState& state = source->state();
    EXPECT_EQ(state.time, time);
    ASSERT_EQ(state.ids, (std::vector<std::uint64_t>{3, 5, 7}));
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_LT((state.positions[i] - cubic(state.ids[i], time)).norm(), 1e-12) << time;
      EXPECT_LT((state.velocities[i] - cubic_velocity(state.ids[i], time)).norm(), 1e-12) << time;
    }
  }
  EXPECT_EQ(source->state().rest_positions[0], Vec3(cubic(3, 1) + Vec3(100, 0, 0)));
  EXPECT_FALSE(source->ends_before(1.0));
  EXPECT_TRUE(source->ends_before(1.01));
  EXPECT_THROW(source->advance_to(1.2), SceneError);
  EXPECT_THROW(source->advance_to(0.2), std::invalid_argument);
}

TEST_F(RecordedSourceTest, MakesUpForMissingVelocitiesAndRestPositions) {
  // x = t^2 at t = 0, 1, 2, 3: differences are central inside, one-sided at the ends.
  for (int k = 0; k < 4; ++k) {
    write(fmt::format("f_{:04}.ply", k), {{0, Vec3(k * k, 0, 0)}, {0, Vec3(0, 1, k)}}, positions_only);
  }
  const auto source = open("f_%04d.ply", 1.0);
  const double expected[] = {1, 2, 4, 5};
  for (int k = 0; k < 4; ++k) {
    source->advance_to(k);
    EXPECT_NEAR(source->state().velocities[0].x(), expected[k], 1e-12);
    EXPECT_NEAR(source->state().velocities[1].z(), 1, 1e-12);
    EXPECT_EQ(source->state().rest_positions[1], Vec3(0, 1, 0));
  }
  // A jump over files must give the same as going through them.
  const auto jumped = open("f_????.ply", 1.0);
  jumped->advance_to(2.5);
  const auto stepped = open("f_????.ply", 1.0);
  for (const double time : {0.3, 1.0, 1.9, 2.5}) stepped->advance_to(time);
  EXPECT_EQ(jumped->state().positions, stepped->state().positions);
  EXPECT_EQ(jumped->state().velocities, stepped->state().velocities);
}

TEST_F(RecordedSourceTest, ParticlesMayComeAndGo) {
  const Vec3 v(1, 0, 0);
  write("a0.ply", {{1, {0, 0, 0}, v}, {2, {5, 0, 0}, v}}, with_ids | with_velocities);
  write("a1.ply", {{2, {5.5, 0, 0}, v}, {4, {9, 0, 0}, v}}, with_ids | with_velocities);
  const auto source = open("a*.ply");
  source->advance_to(0.2);
  EXPECT_EQ(source->state().ids, (std::vector<std::uint64_t>{1, 2}));
  EXPECT_NEAR(source->state().positions[0].x(), 0.2, 1e-12);
  source->advance_to(0.3);
  EXPECT_EQ(source->state().ids, (std::vector<std::uint64_t>{2, 4}));
  EXPECT_NEAR(source->state().positions[1].x(), 8.8, 1e-12);
  source->advance_to(0.5);
  EXPECT_EQ(source->state().ids, (std::vector<std::uint64_t>{2, 4}));
  // Rest positions are those of the first appearance.
  EXPECT_EQ(source->state().rest_positions[0], Vec3(5, 0, 0));
  EXPECT_EQ(source->state().rest_positions[1], Vec3(9, 0, 0));
}

TEST_F(RecordedSourceTest, WrongSequencesAreErrors) {
  const std::vector<TestParticle> one = {{1, {0, 0, 0}}}, two = {{1, {0, 0, 0}}, {2, {1, 0, 0}}};
  write("gap_1.ply", one, with_ids);
  write("gap_2.ply", one, with_ids);
  write("gap_5.ply", one, with_ids);
  EXPECT_THAT(error_of_pattern("gap_*.ply"),
              AllOf(HasSubstr("gap_5.ply"), HasSubstr("gap_2.ply"), HasSubstr("2 files")));
  write("same_1.ply", one, with_ids);
  write("same_01.ply", one, with_ids);
  EXPECT_THAT(error_of_pattern("same_*.ply"), HasSubstr("same number"));
  EXPECT_THAT(error_of_pattern("gapp_1.ply"),
              AllOf(HasSubstr("no file matches"), HasSubstr("did you mean \"gap_1.ply\"?")));
  EXPECT_THAT(error_of_pattern("nowhere/f_*.ply"), HasSubstr("cannot look into the folder"));
  EXPECT_THAT(error_of_pattern("."), AllOf(HasSubstr("folder"), HasSubstr("*.ply")));
  write("n_1.ply", one, positions_only);
  write("n_2.ply", two, positions_only);
  EXPECT_THAT(error_of_pattern("n_*.ply"), AllOf(HasSubstr("n_2.ply"), HasSubstr("no ids")));
  std::ofstream(folder_ / "bad.ply") << "this is no ply";
  EXPECT_THAT(error_of_pattern("bad.ply"), HasSubstr("bad.ply"));
}

TEST_F(RecordedSourceTest, FilesAreOrderedByNumberOrNaturally) {
  for (const char* name : {"f2.ply", "f10.ply", "f9.ply", "f3.ply", "f4.ply", "f5.ply", "f6.ply", "f7.ply", "f8.ply"}) {
    std::ofstream(folder_ / name) << " ";
  }
  const auto files = files_of_pattern((folder_ / "f*.ply").string());
  ASSERT_EQ(files.size(), 9u);
  EXPECT_EQ(files.front().filename(), "f2.ply");
  EXPECT_EQ(files.back().filename(), "f10.ply");
  for (const char* name : {"take10_b.x", "take2_b.x", "take2_a.x"}) std::ofstream(folder_ / name) << " ";
  const auto takes = files_of_pattern((folder_ / "take*.x").string());
  ASSERT_EQ(takes.size(), 3u);
  EXPECT_EQ(takes[0].filename(), "take2_a.x");
  EXPECT_EQ(takes[2].filename(), "take10_b.x");
  // Letters that mean something in regular expressions mean themselves.
  std::ofstream(folder_ / "a+(b)[1].x") << " ";
  EXPECT_EQ(files_of_pattern((folder_ / "a+(b)[%d].x").string()).size(), 1u);
}

}  // namespace
}  // namespace flowskin::scenes
