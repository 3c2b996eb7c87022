// Recorded sequences: written by the test itself as ascii PLY, read back, interpolated.
#include "scenes/sources/recorded_source.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "scene_file_helpers.h"
#include "scenes/sources/file_pattern.h"
#include "scenes/sources/make_source.h"
#include "scenes/sources/particle_sequence.h"
#include "scenes/sources/particle_spacing.h"

namespace flowskin::scenes::recorded_source_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
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

  std::unique_ptr<ParticleSource> open(const std::string& pattern, double interval = 0.5,
                                       RecordedSpec::Ids ids = RecordedSpec::Ids::automatic) const {
    Scene scene;
    scene.directory = folder_.string();
    scene.particles.source = ParticlesSpec::Source::recorded;
    scene.particles.spacing = 0.1;
    scene.particles.recorded.files = {pattern};
    scene.particles.recorded.frame_interval = interval;
    scene.particles.recorded.ids = ids;
    return make_source(scene);
  }

  std::string error_of_pattern(const std::string& pattern) const {
    return error_of([&] { open(pattern); });
  }
  template <class Action>
  static std::string error_of(const Action& action) {
    try {
      action();
    } catch (const InputError& error) {
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
  EXPECT_THROW(source->advance_to(1.2), InputError);
  EXPECT_THROW(source->advance_to(0.2), std::invalid_argument);
}

TEST_F(RecordedSourceTest, MakesUpForMissingVelocitiesAndRestPositions) {
  // x = t^2 at t = 0, 1, 2, 3: differences over three files are exact, at the ends as well.
  for (int k = 0; k < 4; ++k) {
    write(fmt::format("f_{:04}.ply", k), {{0, Vec3(k * k, 0, 0)}, {0, Vec3(0, 1, k)}}, positions_only);
  }
  const auto source = open("f_%04d.ply", 1.0);
  const double expected[] = {0, 2, 4, 6};
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
  write("same_1.ply", one, with_ids);
  write("same_01.ply", one, with_ids);
  EXPECT_THAT(error_of_pattern("same_*.ply"), HasSubstr("same number"));
  EXPECT_THAT(error_of_pattern("gapp_1.ply"),
              AllOf(HasSubstr("no file matches"), HasSubstr("did you mean \"gap_1.ply\"?")));
  EXPECT_THAT(error_of_pattern("nowhere/f_*.ply"), HasSubstr("cannot look into the folder"));
  std::filesystem::create_directories(folder_ / "mixed");
  write("mixed/a_1.ply", one, with_ids);
  std::ofstream(folder_ / "mixed" / "a_1.csv") << "x,y,z\n1,2,3\n";
  EXPECT_THAT(error_of_pattern("mixed"), AllOf(HasSubstr(".csv and .ply"), HasSubstr("one kind")));
  EXPECT_THAT(error_of_pattern("mixed/*"), HasSubstr("one format"));
  std::filesystem::create_directories(folder_ / "none");
  EXPECT_THAT(error_of_pattern("none"), HasSubstr("no particle files"));
  write("n_1.ply", one, positions_only);
  write("n_2.ply", two, positions_only);
  EXPECT_THAT(error_of([&] { open("n_*.ply", 0.5, RecordedSpec::Ids::order)->advance_to(0.5); }),
              AllOf(HasSubstr("n_2.ply"), HasSubstr("no ids")));
  write("c_1.ply", one, with_ids | with_velocities);
  write("c_2.ply", one, with_ids);
  EXPECT_THAT(error_of([&] { open("c_*.ply")->advance_to(0.5); }),
              AllOf(HasSubstr("c_2.ply"), HasSubstr("velocities"), HasSubstr("c_1.ply")));
  std::ofstream(folder_ / "bad.ply") << "this is no ply";
  EXPECT_THAT(error_of_pattern("bad.ply"), HasSubstr("bad.ply"));
}

TEST_F(RecordedSourceTest, FilesAreOrderedByNumberOrNaturally) {
  for (const char* name : {"f2.ply", "f10.ply", "f9.ply", "f3.ply", "f4.ply", "f5.ply", "f6.ply", "f7.ply", "f8.ply"}) {
    std::ofstream(folder_ / name) << " ";
  }
  const auto files = files_of_patterns({(folder_ / "f*.ply").string()}).paths;
  ASSERT_EQ(files.size(), 9u);
  EXPECT_EQ(files.front().filename(), "f2.ply");
  EXPECT_EQ(files.back().filename(), "f10.ply");
  // As a shell writes a list, and as a folder.
  EXPECT_EQ(files_of_patterns({files[8].string(), files[0].string(), files[1].string()}).paths,
            (std::vector<std::filesystem::path>{files[0], files[1], files[8]}));
  EXPECT_EQ(files_of_patterns({folder_.string()}).paths, files);
  EXPECT_THROW(files_of_patterns({files[0].string(), files[0].string()}), InputError);
  for (const char* name : {"take10_b.x", "take2_b.x", "take2_a.x"}) std::ofstream(folder_ / name) << " ";
  const auto takes = files_of_patterns({(folder_ / "take*.x").string()}).paths;
  ASSERT_EQ(takes.size(), 3u);
  EXPECT_EQ(takes[0].filename(), "take2_a.x");
  EXPECT_EQ(takes[2].filename(), "take10_b.x");
  // Letters that mean something in regular expressions mean themselves.
  std::ofstream(folder_ / "a+(b)[1].x") << " ";
  EXPECT_EQ(files_of_patterns({(folder_ / "a+(b)[%d].x").string()}).paths.size(), 1u);
}

TEST_F(RecordedSourceTest, PatternsOfNames) {
  const std::string long_name = std::string(200, 'a') + ".csv";
  for (const char* name : {"p.csv", "p_1.csv", "p_12.csv", "p_x.csv", "p%d", long_name.c_str()})
    std::ofstream(folder_ / name) << " ";
  const auto count = [&](const std::string& pattern) {
    try {
      return files_of_patterns({(folder_ / pattern).string()}).paths.size();
    } catch (const InputError&) {
      return std::size_t{0};
    }
  };
  EXPECT_EQ(count("p_%d.csv"), 2u);
  EXPECT_EQ(count("p_%04d.csv"), 2u);
  EXPECT_EQ(count("p_%d2.csv"), 1u);  // the number is 1
  EXPECT_EQ(count("p_?.csv"), 2u);
  EXPECT_EQ(count("p_*.csv"), 3u);
  EXPECT_EQ(count("p*.csv"), 4u);
  EXPECT_EQ(count("**p**.c*"), 4u);
  EXPECT_EQ(count("p_%4.csv"), 0u);
  EXPECT_EQ(count("?"), 0u);
  EXPECT_EQ(count("*.csv*"), 5u);
  // Where each * could take any letters, the ways to share them out are never counted through.
  std::string stars;
  for (int k = 0; k < 100; ++k) stars += "*a";
  EXPECT_EQ(count(stars + "b"), 0u);
  EXPECT_EQ(count(stars + "*"), 1u);
}

TEST_F(RecordedSourceTest, GapsInTheNumbersAreMissingFiles) {
  for (const int k : {0, 10, 20, 50})
    write(fmt::format("g_{}.ply", k), cubic_particles({1, 2}, k / 50.0), with_ids | with_velocities);
  const NumberedFiles files = files_of_patterns({(folder_ / "g_*.ply").string()});
  EXPECT_EQ(files.steps, (std::vector<std::uint64_t>{0, 1, 2, 5}));
  EXPECT_THAT(files.missing, AllOf(HasSubstr("2 of 6"), HasSubstr("g_20.ply")));
  const auto source = open("g_*.ply", 0.2);
  EXPECT_FALSE(source->ends_before(1.0));
  EXPECT_TRUE(source->ends_before(1.001));
  for (const double time : {0.2, 0.6, 0.75, 1.0}) {  // Hermite curves are exact for the cubic paths
    source->advance_to(time);
    EXPECT_LT((source->state().positions[1] - cubic(2, time)).norm(), 1e-12);
  }
  // Time steps of a solver are no frame numbers.
  for (const int k : {1033, 2071, 3110}) std::ofstream(folder_ / fmt::format("step_{}.csv", k)) << "x,y,z\n1,2,3\n";
  const NumberedFiles steps = files_of_patterns({(folder_ / "step_*.csv").string()});
  EXPECT_EQ(steps.steps, (std::vector<std::uint64_t>{0, 1, 2}));
  EXPECT_EQ(steps.missing, "");
  EXPECT_THAT(steps.uneven, HasSubstr("1033, 2071, 3110"));
}

TEST_F(RecordedSourceTest, FilesWithoutEndsAndOneFolderATime) {
  const auto touch = [&](const std::string& name) {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << "x,y,z\n1,2,3\n";
  };
  const auto names = [&](const std::vector<std::string>& patterns) {
    std::vector<std::string> absolute, result;
    for (const std::string& pattern : patterns) absolute.push_back((folder_ / pattern).string());
    for (const auto& file : files_of_patterns(absolute).paths)
      result.push_back(file.lexically_relative(folder_).string());
    return result;
  };
  for (const char* name :
       {"dump/dump.0", "dump/dump.100", "dump/dump.20", "run/0/p.csv", "run/0.0005/p.csv", "run/1e-05/p.csv",
        "run/constant/p.csv", "times/0.5/p.csv", "times/10/p.csv", "times/2/p.csv", "upper/P_1.CSV", "upper/P_2.csv"})
    touch(name);
  const auto dumps = ElementsAre("dump/dump.0", "dump/dump.20", "dump/dump.100");
  EXPECT_THAT(names({"dump"}), dumps);
  EXPECT_THAT(names({"dump/dump.*"}), dumps);
  EXPECT_THAT(names({"dump/dump.100", "dump/dump.0", "dump/dump.20"}), dumps);
  EXPECT_THAT(names({"run/0*/p.csv", "run/1e*/p.csv"}),
              ElementsAre("run/0/p.csv", "run/1e-05/p.csv", "run/0.0005/p.csv"));
  const auto times = ElementsAre("times/0.5/p.csv", "times/2/p.csv", "times/10/p.csv");
  EXPECT_THAT(names({"times"}), times);
  EXPECT_THAT(names({"times/*/p.csv"}), times);
  EXPECT_THAT(names({"times/10/p.csv", "times/0.5/p.csv", "times/2/p.csv"}), times);
  EXPECT_THAT(names({"upper"}), ElementsAre("upper/P_1.CSV", "upper/P_2.csv"));
  touch("times/2/q.csv");
  EXPECT_THAT(error_of([&] { names({"times"}); }), HasSubstr("times/*/p.csv"));
  RecordedSpec spec;
  spec.files = {"times/*/p.csv"};
  EXPECT_THAT(open_sequence(spec, folder_.string()).notes, testing::Contains(HasSubstr("--times-in-names")));
  spec.times_in_names = true;
  EXPECT_EQ(open_sequence(spec, folder_.string()).times, (std::vector<double>{0, 1.5, 9.5}));
}

TEST_F(RecordedSourceTest, SeveralBodiesInOnePlaceAreNoSequence) {
  const auto error_in = [&](const std::string& folder, const std::vector<std::string>& names,
                            const std::string& pattern = "") {
    for (const std::string& name : names) {
      std::filesystem::create_directories((folder_ / folder / name).parent_path());
      std::ofstream(folder_ / folder / name) << "x,y,z\n1,2,3\n";
    }
    return error_of([&] { files_of_patterns({(folder_ / folder / pattern).string()}); });
  };
  EXPECT_THAT(error_in("a", {"boundary_0001.csv", "boundary_0002.csv", "fluid_0001.csv", "fluid_0002.csv"}),
              AllOf(HasSubstr("2 groups"), HasSubstr("boundary_*.csv (2 files)"), HasSubstr("a/fluid_*.csv'")));
  EXPECT_THAT(error_in("b", {"PartFluid_0000.vtk", "PartFluid_0001.vtk", "PartBound_0000.vtk", "PartBound_0001.vtk"}),
              HasSubstr("b/PartFluid_*.vtk'"));
  EXPECT_THAT(error_in("c", {"f_1.csv", "f_2.csv", "f_3.csv", "walls.csv"}),
              AllOf(HasSubstr("f_*.csv (3 files)"), HasSubstr("walls.csv")));
  EXPECT_THAT(error_in("d", {"fluid.csv", "boundary.csv"}), AllOf(HasSubstr("2 groups"), HasSubstr("d/fluid.csv'")));
  // Bodies, or pieces of one moment, that are told apart by a number.
  EXPECT_THAT(
      error_in("e", {"body0_01.csv", "body0_02.csv", "body0_03.csv", "body1_01.csv", "body1_02.csv", "body1_03.csv"}),
      AllOf(HasSubstr("body0_*.csv (3 files)"), HasSubstr("body1_*.csv (3 files)")));
  EXPECT_THAT(error_in("f", {"p_01_r0.csv", "p_01_r1.csv", "p_02_r0.csv", "p_02_r1.csv", "p_03_r0.csv", "p_03_r1.csv"}),
              HasSubstr("p_*_r0.csv (3 files)"));
  EXPECT_THAT(error_in("g", {"fluid/1.csv", "fluid/2.csv", "wall/1.csv", "wall/2.csv"}, "*/*.csv"),
              HasSubstr("g/fluid/*.csv'"));
  // A pattern that fits the one group only.
  EXPECT_THAT(error_in("h", {"1.csv", "2.csv", "3.csv", "wall_1.csv", "wall_2.csv"}), HasSubstr("h/%d.csv'"));
  EXPECT_EQ(files_of_patterns({(folder_ / "h/%d.csv").string()}).paths.size(), 3U);
  EXPECT_EQ(files_of_patterns({(folder_ / "a/fluid_*.csv").string()}).paths.size(), 2U);
  EXPECT_THAT(error_of([&] { files_of_patterns({(folder_ / "a/*.csv").string()}); }), HasSubstr("2 groups"));
  // Who names every file knows what they are.
  EXPECT_EQ(files_of_patterns({(folder_ / "d/fluid.csv").string(), (folder_ / "d/boundary.csv").string()}).paths.size(),
            2U);
}

TEST_F(RecordedSourceTest, TimesComeFromTheFilesWhereNobodyTellsThem) {
  const auto sequence = [&](const std::string& pattern, double interval = 0) {
    RecordedSpec spec;
    spec.files = {pattern};
    spec.frame_interval = interval;
    return open_sequence(spec, folder_.string());
  };
  const auto write_times = [&](const std::string& name, const std::vector<double>& times) {
    for (std::size_t k = 0; k < times.size(); ++k)
      std::ofstream(folder_ / fmt::format("{}_{}.csv", name, k))
          << fmt::format("time,id,x,y,z\n{},1,{},0,0\n", times[k], k);
  };
  // Rounded to single precision, as files hold them, with one file missing.
  write_times("even", {3.0f, 3.04f, 3.08f, 3.16f});
  const ParticleSequence even = sequence("even_*.csv");
  EXPECT_TRUE(even.is_even);
  EXPECT_EQ(even.interval, 1 / 25.0);
  EXPECT_EQ(even.times, (std::vector<double>{0, 1 / 25.0, 2 / 25.0, 4 / 25.0}));
  EXPECT_EQ(even.warnings.size(), 1U);
  EXPECT_EQ(sequence("even_*.csv", 0.5).times.back(), 1.5);  // who tells it is right
  write_times("uneven", {0, 0.1, 0.25, 0.33});
  const ParticleSequence uneven = sequence("uneven_*.csv");
  EXPECT_FALSE(uneven.is_even);
  EXPECT_EQ(uneven.times, (std::vector<double>{0, 0.1, 0.25, 0.33}));
  write_times("back", {0, 0.1, 0.05});
  EXPECT_EQ(sequence("back_*.csv").interval, 1.0 / 30);
  EXPECT_THAT(sequence("back_*.csv").notes, testing::Contains(HasSubstr("do not ascend")));
  write("none_0.ply", {{1, {0, 0, 0}}}, with_ids);
  write("none_1.ply", {{1, {0, 0, 0}}}, with_ids);
  EXPECT_THAT(sequence("none_*.ply").notes, testing::Contains(HasSubstr("1/30 s")));
  std::ofstream(folder_ / "run.pvd") << "<VTKFile type=\"Collection\"><Collection><DataSet timestep=\"0.5\" "
                                        "file=\"even_1.csv\"/><DataSet timestep=\"0\" file=\"even_0.csv\"/>"
                                        "</Collection></VTKFile>";
  const ParticleSequence collection = sequence("run.pvd");
  EXPECT_EQ(collection.times, (std::vector<double>{0, 0.5}));
  EXPECT_EQ(collection.places[0].file.filename(), "even_0.csv");
}

TEST_F(RecordedSourceTest, WithoutIdsTheirOrderCountsWhereItLasts) {
  std::vector<TestParticle> particles, shuffled;
  for (int i = 0; i < 125; ++i) particles.push_back({0, Vec3(i % 5, i / 5 % 5, i / 25) * 0.1});
  for (int i = 0; i < 125; ++i) shuffled.push_back({0, particles[(i * 62) % 125].position + Vec3(0.01, 0, 0)});
  write("same_0.ply", particles, positions_only);
  write("same_1.ply", particles, positions_only);
  write("mess_0.ply", particles, positions_only);
  write("mess_1.ply", shuffled, positions_only);
  write("more_0.ply", particles, with_velocities);
  particles.push_back({0, {1, 1, 1}});
  write("more_1.ply", particles, with_velocities);
  const auto state_of = [&](const std::string& pattern, RecordedSpec::Ids ids = RecordedSpec::Ids::automatic) {
    const auto source = open(pattern, 0.5, ids);
    source->advance_to(0.125);
    return source->state();
  };
  EXPECT_TRUE(state_of("same_*.ply").has_lasting_ids);
  EXPECT_FALSE(state_of("same_*.ply", RecordedSpec::Ids::none).has_lasting_ids);
  const ParticleState mess = state_of("mess_*.ply");
  EXPECT_FALSE(mess.has_lasting_ids || mess.has_velocities || mess.has_material);
  // Between the files both states are there, with weights.
  const ParticleState more = state_of("more_*.ply");
  EXPECT_TRUE(more.has_velocities && !more.has_lasting_ids);
  ASSERT_EQ(more.weights.size(), 125U + 126U);
  EXPECT_EQ(more.weights.front(), 0.75);
  EXPECT_EQ(more.weights.back(), 0.25);
  EXPECT_EQ(more.ids.back(), 250U);
}

TEST_F(RecordedSourceTest, ParticlesThatJumpHaveNoVelocityFromTheJump) {
  for (int k = 0; k < 4; ++k) {
    std::vector<TestParticle> particles;
    for (int i = 0; i < 20; ++i) particles.push_back({static_cast<std::uint64_t>(i), Vec3(0.1 * i + 0.01 * k, 0, 0)});
    if (k >= 2) particles[7].position += Vec3(50, 0, 0);
    write(fmt::format("jump_{}.ply", k), particles, with_ids);
  }
  const auto source = open("jump_*.ply", 0.5);
  for (const double time : {0.0, 0.5, 1.0, 1.5}) {
    source->advance_to(time);
    for (const Vec3& velocity : source->state().velocities) EXPECT_NEAR(velocity.x(), 0.02, 1e-12) << time;
  }
}

// A stream along x of so many spacings a file; what leaves at its end comes in again under the same id.
std::vector<TestParticle> stream(double file, double spacings = 0.5, int length = 20) {
  std::vector<TestParticle> particles;
  for (int i = 0; i < length; ++i) {
    for (int j = 0; j < 2; ++j) {
      const double place = std::fmod(i + spacings * file, length);
      particles.push_back(
          {static_cast<std::uint64_t>(2 * i + j), Vec3(0.1 * place, 0.1 * j, 0), Vec3(0.2 * spacings, 0, 0)});
    }
  }
  return particles;
}

TEST_F(RecordedSourceTest, ParticlesThatAreUsedAgainDoNotFlyThroughTheFluid) {
  for (const int columns : {with_ids | with_velocities, int{with_ids}}) {
    for (const auto& [spacings, length] : {std::pair{0.5, 20}, std::pair{3.0, 40}}) {
      for (int k = 0; k < 12; ++k) write(fmt::format("stream_{:02}.ply", k), stream(k, spacings, length), columns);
      const auto source = open("stream_*.ply", 0.5);
      for (double time = 0; time <= 5.5; time += 0.125) {
        source->advance_to(time);
        const ParticleState& state = source->state();
        EXPECT_EQ(state.ids.size(), 2U * length) << time;
        for (std::size_t i = 0; i < state.ids.size(); ++i) {
          EXPECT_NEAR(state.velocities[i].x(), 0.2 * spacings, 1e-12) << columns << " " << time;
          EXPECT_GT(state.positions[i].x(), -0.1 * spacings - 1e-12);
          EXPECT_LT(state.positions[i].x(), 0.1 * length + 0.1 * spacings + 1e-12);
        }
      }
    }
  }
}

// Its material is that of the inlet from then on, and a run that is resumed at any file says so, too.
TEST_F(RecordedSourceTest, ParticlesThatAreUsedAgainAreNewMaterial) {
  for (int k = 0; k < 12; ++k) write(fmt::format("stream_{:02}.ply", k), stream(k), with_ids);
  for (const double stop : {0.5, 1.25, 2.0, 3.5}) {
    const auto source = open("stream_*.ply", 0.5);
    source->advance_to(stop);
    std::string saved;
    StateWriter writer([&](std::string_view bytes) { saved += bytes; });
    source->save(writer);
    writer.flush();
    const auto resumed = open("stream_*.ply", 0.5);
    StateReader reader(saved);
    resumed->restore(reader);
    for (const double time : {4.0, 4.25, 5.5}) {
      source->advance_to(time);
      resumed->advance_to(time);
      EXPECT_EQ(source->state().rest_positions, resumed->state().rest_positions) << stop << " " << time;
      EXPECT_EQ(source->state().positions, resumed->state().positions) << stop << " " << time;
    }
    const ParticleState& state = source->state();  // eleven half spacings: five layers have come in again
    for (std::size_t i = 0; i < state.ids.size(); ++i) {
      const bool again = state.ids[i] >= 30;
      EXPECT_EQ(state.rest_positions[i].x() < 0.1, again || state.ids[i] < 2) << state.ids[i];
    }
  }
}

TEST_F(RecordedSourceTest, IsNotResumedWithOtherParticles) {
  const auto write_file = [&](int k, double y) {
    write(fmt::format("f_{}.ply", k), {{1, Vec3(k, y, 0)}, {2, Vec3(k, 0, 2)}}, with_ids | with_velocities);
  };
  for (int k = 0; k < 6; ++k) write_file(k, 1);
  std::string saved;
  {
    const auto source = open("f_*.ply", 0.1);
    source->advance_to(0.15);  // between the files 1 and 2
    StateWriter writer([&](std::string_view bytes) { saved += bytes; });
    source->save(writer);
    writer.flush();
  }
  const auto resume = [&] {
    const auto source = open("f_*.ply", 0.1);
    StateReader reader(saved);
    source->restore(reader);
    return source->state().positions.front();
  };
  EXPECT_EQ(resume(), Vec3(1.5, 1, 0));
  write_file(5, 3);  // nothing has come of it yet
  EXPECT_EQ(resume(), Vec3(1.5, 1, 0));
  write_file(1, 3);  // as long as before
  EXPECT_THAT(error_of([&] { resume(); }), AllOf(HasSubstr("f_1.ply"), HasSubstr("changed")));
}

TEST_F(RecordedSourceTest, AParticleThatFlewOffIsLeftOutWhereNoGridReachesIt) {
  for (int k = 0; k < 2; ++k) {
    std::vector<TestParticle> particles;
    for (std::uint64_t i = 0; i < 60; ++i)
      particles.push_back({i, 0.1 * Vec3(double(i % 4), double(i / 4 % 4), double(i / 16))});
    particles.push_back({60, k == 0 ? Vec3(0.4, 0, 0) : Vec3(1e7, 0, 0)});
    particles.push_back({61, Vec3(50, 0, 0)});
    write(fmt::format("stray_{}.ply", k), particles, with_ids);
  }
  const auto source = open("stray_*.ply");
  EXPECT_EQ(source->state().ids.size(), 62U);
  EXPECT_EQ(source->statistics().not_wanted, 0U);
  source->advance_to(0.5);
  EXPECT_EQ(source->state().ids.size(), 61U);
  EXPECT_EQ(source->statistics().not_wanted, 1U);
}

TEST_F(RecordedSourceTest, OptionsThatLeaveNoParticleAreNamed) {
  for (const char* name : {"f_0.ply", "f_1.ply"}) write(name, {{1, {0, 0, 0}}, {2, {1, 2, 3}}}, with_ids);
  RecordedSpec spec;
  spec.files = {"f_*.ply"};
  spec.keep = "x > 0.5";
  spec.region = {{9, 9, 9}, {8, 8, 8}};
  const auto opened = [&] { return error_of([&] { open_sequence(spec, folder_.string()); }); };
  EXPECT_THAT(opened(), AllOf(HasSubstr("no particle is left in this and 1 other frame; "),
                              HasSubstr("left out of 4: 2 by --keep, 2 by --region"),
                              HasSubstr("between (0, 0, 0) and (1, 2, 3) m")));
  spec.region = {{2, 2, 9}, {-1, 1, 2}};  // corners in any order
  EXPECT_EQ(opened(), "no error");
  spec.region.clear();
  spec.keep = "x > 1 and f_1 == 0 or x == 7";
  EXPECT_THAT(opened(), HasSubstr("there is no column \"f_1\""));
}

TEST_F(RecordedSourceTest, VelocitiesThatContradictTheMotionAreWarnedOf) {
  const auto write_moving = [&](const std::string& name, double factor) {
    for (int k = 0; k < 3; ++k) {
      std::vector<TestParticle> particles;
      for (std::uint64_t i = 0; i < 60; ++i)
        particles.push_back({i, Vec3(0.1 * double(i % 4), 0.1 * double(i / 4 % 4) - 0.05 * k, 0.1 * double(i / 16)),
                             Vec3(0, -0.1 * factor, 0)});
      write(fmt::format("{}_{}.ply", name, k), particles, with_ids | with_velocities);
    }
  };
  write_moving("right", 1);
  write_moving("fast", 8);
  write_moving("back", -1);
  EXPECT_TRUE(open("right_*.ply")->warnings().empty());
  EXPECT_THAT(open("fast_*.ply")->warnings(),
              ElementsAre(AllOf(HasSubstr("0.125 times"), HasSubstr("--time-step 0.0625"))));
  EXPECT_THAT(open("back_*.ply")->warnings(), ElementsAre(HasSubstr("do not move as")));
}

TEST_F(RecordedSourceTest, SpacingIsEstimatedFromDistances) {
  std::vector<Vec3> lattice;
  for (int i = 0; i < 1000; ++i) lattice.emplace_back(0.02 * Vec3(i % 10, i / 10 % 10, i / 100));
  EXPECT_NEAR(estimated_spacing(lattice), 0.02, 1e-12);
  EXPECT_EQ(estimated_spacing({}), 0);
  EXPECT_EQ(estimated_spacing({{1, 1, 1}}), 0);
}

}  // namespace
}  // namespace flowskin::scenes::recorded_source_test
