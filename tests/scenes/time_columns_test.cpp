// Tables of many time steps, whatever the column that tells them apart is called.
#include "scenes/io/time_columns.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>

#include "common/errors.h"
#include "io_fixture.h"
#include "scenes/io/particle_file.h"

namespace flowskin::scenes::time_columns_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<ParticleTable> steps_of(const std::string& text) { return parse_particle_steps(text, "a.csv"); }

/// Three steps of four particles, by step or by particle.
std::string table(const std::string& column, const std::vector<std::string>& values, bool with_ids, bool by_particle) {
  std::vector<std::string> lines;
  for (std::size_t k = 0; k < values.size(); ++k)
    for (int i = 0; i < 4; ++i) {
      const std::string row = fmt::format("{},{},{},0,0\n", with_ids ? std::to_string(i) : "7.5", values[k], i);
      lines.insert(by_particle ? lines.begin() + static_cast<std::ptrdiff_t>(i * (k + 1) + k) : lines.end(), row);
    }
  return fmt::format("{},{},x,y,z\n{}", with_ids ? "id" : "mass", column, fmt::join(lines, ""));
}

TEST(TimeColumns, NamesOfTime) {
  for (const char* name : {"t", "T", "Time", "time_s", "Time [s]", "time(sec)", "TimeValue", "sim_time", "Time (s)",
                           "t [s]", "physical time", "seconds", "Simulation Time"}) {
    ASSERT_TRUE(time_name(name)) << name;
    EXPECT_FALSE(time_name(name)->is_step) << name;
    EXPECT_EQ(time_name(name)->unit, 1) << name;
  }
  for (const char* name : {"step", "Step", "frame", "FRAME", "timestep", "Time Step", "TimeStep", "iteration", "iter",
                           "Frame No.", "frame_number", "time_index", "nstep", "i_step", "cycle", "snapshot"}) {
    ASSERT_TRUE(time_name(name)) << name;
    EXPECT_TRUE(time_name(name)->is_step) << name;
  }
  EXPECT_EQ(time_name("time_ms")->unit, 1e-3);
  EXPECT_EQ(time_name("Time [ms]")->unit, 1e-3);
  EXPECT_EQ(time_name("t [µs]")->unit, 1e-6);
  EXPECT_EQ(time_name("time (min)")->unit, 60);
  for (const char* name :
       {"x", "type", "id", "temperature", "T0", "time_of_birth", "stepsize", "dt", "u", "frame_x", "mass"})
    EXPECT_FALSE(time_name(name)) << name;
}

TEST(TimeColumns, StepsAreToldApartByAnyOfTheNames) {
  for (const bool with_ids : {true, false}) {
    for (const char* name : {"t", "time_s", "Time [s]", "Time", "seconds"}) {
      const auto steps = steps_of(table(name, {"0", "0.25", "0.5"}, with_ids, false));
      ASSERT_EQ(steps.size(), 3U) << name;
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(steps[k].time, static_cast<double>(k) / 4) << name;
        EXPECT_EQ(steps[k].count, 4U);
      }
      EXPECT_THAT(steps[0].notes, testing::ElementsAre(HasSubstr(fmt::format("\"{}\"", name))));
    }
    for (const char* name : {"step", "frame", "timestep", "iteration", "Frame No.", "cycle"}) {
      const auto steps = steps_of(table(name, {"10", "20", "40"}, with_ids, false));
      ASSERT_EQ(steps.size(), 3U) << name;
      EXPECT_EQ(steps[2].step, 40U) << name;
      EXPECT_FALSE(steps[2].time) << name;
    }
  }
  EXPECT_EQ(steps_of(table("time_ms", {"0", "250", "500"}, true, false))[2].time, 0.5);
  // The path of one particle after the other.
  for (const char* name : {"t", "frame", "time"})
    EXPECT_EQ(steps_of(table(name, {"0", "1", "2"}, true, true)).size(), 3U);
  // A step's name given to times.
  EXPECT_EQ(steps_of(table("timestep", {"0", "0.25", "0.5"}, true, false))[1].time, 0.25);
}

TEST(TimeColumns, TheColumnThatTellsMoreApartCounts) {
  // Times are rounded: two steps have the same one.
  const std::string text =
      "t,frame,id,x,y,z\n0.0,0,1,0,0,0\n0.0,0,2,1,0,0\n0.0,1,1,0,0,0\n0.0,1,2,1,0,0\n0.1,2,1,0,0,0\n"
      "0.1,2,2,1,0,0\n";
  const auto steps = steps_of(text);
  ASSERT_EQ(steps.size(), 3U);
  EXPECT_EQ(steps[2].step, 2U);
}

TEST(TimeColumns, WhatIsNoTimeDoesNotTakeAStepApart) {
  EXPECT_EQ(steps_of("id,x,y,z,t\n1,0,0,0,300\n2,1,0,0,300\n3,2,0,0,350\n4,3,0,0,350\n").size(), 1U);
  EXPECT_EQ(steps_of("x,y,z,t\n0,0,0,300\n1,0,0,350\n2,0,0,300\n3,0,0,350\n").size(), 1U);
  const auto born = steps_of("id,x,y,z,frame\n1,0,0,0,1\n2,1,0,0,1\n3,2,0,0,2\n4,3,0,0,2\n");
  ASSERT_EQ(born.size(), 1U);
  EXPECT_THAT(born[0].notes, testing::ElementsAre(AllOf(HasSubstr("\"frame\""), HasSubstr("one time step"))));
  EXPECT_EQ(steps_of("id,x,y,z,t\n1,0,0,0,0.5\n2,1,0,0,0.5\n")[0].time, 0.5);
}

TEST(TimeColumns, RepeatedIdsNameTheColumnThatTellsThemApart) {
  const std::string text = table("moment", {"0", "1", "2"}, true, false);
  const auto error = [&](const std::string& keep) {
    ParticleNeeds needs;
    needs.keep = keep;
    return message_of<InputError>([&] { particles_of_file(steps_of(text).front(), "a.csv", needs); });
  };
  EXPECT_THAT(error(""), AllOf(HasSubstr("several time steps"), HasSubstr("\"moment\""), HasSubstr("\"step\"")));
  ParticleNeeds one;
  one.keep = "moment == 1";
  EXPECT_EQ(particles_of_file(steps_of(text).front(), "a.csv", one).state.ids.size(), 4U);
  // Without ids nothing is repeated, but what counts in blocks is said.
  EXPECT_THAT(steps_of(table("moment", {"0", "1", "2"}, false, false))[0].notes,
              testing::ElementsAre(HasSubstr("\"moment\"")));
  EXPECT_THAT(steps_of(table("Type", {"0", "1", "2"}, false, false))[0].notes, IsEmpty());
}

TEST(TimeColumns, RemarksBetweenRowsBeginAStep) {
  for (const char* remark : {"# time = {}\n", "# t: {}\n", "# Time [s] {}\n", "# frame 7, remark\n# time {}\n"}) {
    std::string text = "# made by nobody\n";
    for (int k = 0; k < 3; ++k) {
      text += fmt::format(fmt::runtime(remark), k / 4.0) + (k == 0 ? "id,x,y,z\n" : "");
      for (int i = 0; i < 3; ++i) text += fmt::format("{},{},0,0\n", i, i);
    }
    const auto steps = steps_of(text);
    ASSERT_EQ(steps.size(), 3U) << text;
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(steps[k].time, static_cast<double>(k) / 4);
  }
  EXPECT_EQ(steps_of("# step 3\nx y z\n0 0 0\n1 0 0\n# step 5\n0 0 0\n1 0 0\n")[1].step, 5U);
  EXPECT_THAT(message_of<InputError>([] { steps_of("x y z\n0 0 0\n1 0 0\n# time 5\n0 0 0\n1 0 0\n"); }),
              AllOf(HasSubstr("line 5"), HasSubstr("time")));
  EXPECT_EQ(steps_of("x y z\n0 0 0\n1 0 0\n# elapsed: 5 s\n").size(), 1U);
}

TEST(TimeColumns, TablesOfOtherFormatsToo) {
  std::string rows, list;
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 3; ++i)
      rows +=
          fmt::format("{}{{\"id\": {}, \"frame\": {}, \"x\": {}, \"y\": 0, \"z\": 0}}", k + i > 0 ? "," : "", i, k, i);
  EXPECT_EQ(parse_particle_steps("[" + rows + "]", "a.json").size(), 3U);
  std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty int id\nproperty float time\nproperty float x\n"
      "property float y\nproperty float z\nend_header\n";
  for (int k = 0; k < 2; ++k)
    for (int i = 0; i < 3; ++i) ply += fmt::format("{} {} {} 0 0\n", i, k / 2.0, i);
  EXPECT_EQ(parse_particle_steps(ply, "a.ply").size(), 2U);
}

}  // namespace
}  // namespace flowskin::scenes::time_columns_test
