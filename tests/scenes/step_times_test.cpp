// Times by the numbers of time steps: alone, in LAMMPS dumps, and in the names of files.
#include "scenes/sources/step_times.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "io_fixture.h"
#include "scenes/sources/particle_sequence.h"

namespace flowskin::scenes::step_times_test {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class StepTimesTest : public IoTest {
 protected:
  static std::string dump(const std::vector<int>& steps) {
    std::string text;
    for (const int step : steps)
      text += fmt::format(
          "ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\n"
          "ITEM: ATOMS id x y z\n1 0 0 0\n2 0.5 0 0\n",
          step);
    return text;
  }
  ParticleSequence open(const std::string& name, double interval = 0) const {
    RecordedSpec spec;
    spec.files = {path(name).string()};
    spec.frame_interval = interval;
    return open_sequence(spec, "/");
  }
  static std::string said(const ParticleSequence& sequence) {
    std::string text;
    for (const std::string& note : sequence.notes) text += note + "\n";
    for (const std::string& warning : sequence.warnings) text += "warning: " + warning + "\n";
    return text;
  }
};

TEST_F(StepTimesTest, OfEvenNumbersAreCounted) {
  const StepTimes times = times_of_steps({0, 10, 20, 40}, "a");
  EXPECT_THAT(times.places, ElementsAre(0, 1, 2, 4));
  EXPECT_EQ(times.unit, 10);
  EXPECT_TRUE(times.are_even);
  EXPECT_THAT(times.warning, HasSubstr("1 of 5 time steps are missing by their numbers (the first after 20)"));
}

TEST_F(StepTimesTest, OfUnevenNumbersAreInProportion) {
  const StepTimes times = times_of_steps({1007, 1050, 1203, 1299}, "a");
  EXPECT_THAT(times.places, ElementsAre(0, DoubleNear(43 / 96.0, 1e-15), DoubleNear(196 / 96.0, 1e-15),
                                        DoubleNear(292 / 96.0, 1e-15)));
  EXPECT_EQ(times.unit, 96);
  EXPECT_FALSE(times.are_even);
  EXPECT_THAT(times.warning, IsEmpty());
  EXPECT_THAT(times_of_steps({0, 101, 199, 300, 1404, 1503}, "a").warning, HasSubstr("1104 after 300"));
}

TEST_F(StepTimesTest, AreNotToldByAbsurdGapsOrNumbersThatDoNotAscend) {
  const StepTimes absurd = times_of_steps({1, 2, 900000000001}, "a");
  EXPECT_THAT(absurd.places, IsEmpty());
  EXPECT_THAT(absurd.warning, HasSubstr("gaps too large for numbers of steps"));
  EXPECT_THAT(times_of_steps({3, 2}, "a").warning, HasSubstr("do not ascend"));
  EXPECT_THAT(times_of_steps({3}, "a").places, IsEmpty());
}

TEST_F(StepTimesTest, OfALammpsDumpAreInProportionAndSayOfWhat) {
  write_text("a.dump", dump({1007, 1050, 1203, 1299}));
  const ParticleSequence given = open("a.dump", 0.96), assumed = open("a.dump");
  EXPECT_THAT(given.times, ElementsAre(0, DoubleNear(0.43, 1e-12), DoubleNear(1.96, 1e-12), DoubleNear(2.92, 1e-12)));
  EXPECT_NEAR(given.interval, 0.96, 1e-15);
  EXPECT_THAT(said(given), HasSubstr("96 time steps are 0.96 s"));
  EXPECT_NEAR(assumed.times[1], 43 / 96.0 / 30, 1e-12);
  EXPECT_THAT(said(assumed), HasSubstr("1/30 s for 96 time steps is assumed; --frame-rate or --time-step sets it"));
}

/// One step a file: the numbers inside count, whatever the names say.
TEST_F(StepTimesTest, OfOneStepAFileStandInTheFiles) {
  for (const int step : {0, 3, 10, 300}) write_text(fmt::format("p_{:05}.dump", step), dump({step}));
  const ParticleSequence sequence = open("p_*.dump", 0.7);
  EXPECT_THAT(sequence.times, ElementsAre(0, DoubleNear(0.3, 1e-12), DoubleNear(1, 1e-12), DoubleNear(30, 1e-10)));
  EXPECT_THAT(said(sequence), testing::AllOf(HasSubstr("in proportion"), HasSubstr("290 after 10")));
  EXPECT_THAT(said(sequence), testing::Not(HasSubstr("only give the order")));
}

TEST_F(StepTimesTest, OfFilesWithoutThemAreNotTakenFromDatesInNames) {
  for (const int day : {20240101, 20240102, 20240501}) write_text(fmt::format("f_{}.csv", day), "x,y,z\n0,0,0\n");
  const ParticleSequence sequence = open("f_*.csv", 0.5);
  EXPECT_THAT(sequence.times, ElementsAre(0, 0.5, 1));
  EXPECT_THAT(said(sequence), HasSubstr("they only give the order"));
}

}  // namespace
}  // namespace flowskin::scenes::step_times_test
