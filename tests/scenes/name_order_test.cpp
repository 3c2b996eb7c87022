// Order of files by the numbers in their names: names as programs write them.
#include "scenes/sources/name_order.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>

namespace flowskin::scenes {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

using Names = std::vector<std::string>;

/// The names come in any order and must come out in the one given here.
void expect_order(const Names& names, const std::string& note_has = "", std::uint64_t missing = 0) {
  std::mt19937 random(7);
  for (int repeat = 0; repeat < 3; ++repeat) {
    Names mixed = names;
    std::shuffle(mixed.begin(), mixed.end(), random);
    const NameOrder order = order_of_names(mixed);
    Names result;
    for (const std::size_t k : order.order) result.push_back(mixed[k]);
    EXPECT_EQ(result, names);
    EXPECT_FALSE(order.twins);
    EXPECT_EQ(order.note.empty(), note_has.empty()) << order.note;
    EXPECT_THAT(order.note, HasSubstr(note_has));
    EXPECT_EQ(raster_of(order).missing, missing) << names[0];
  }
}

TEST(NameOrder, WholeNumbers) {
  expect_order({"f2.ply", "f9.ply", "f10.ply"}, "", 6);
  expect_order({"part.0000", "part.0001", "part.0010", "part.0011"}, "", 8);
  expect_order({"dump.0", "dump.100", "dump.1000"}, "", 8);
  expect_order({"particles_9", "particles_10", "particles_11"});
  expect_order({"fluid_t1_0.h5", "fluid_t1_5.h5", "fluid_t1_10.h5"});
  expect_order({"1.mp3d", "2.mp3d", "11.mp3d"}, "", 8);
  expect_order({"20240301100000000000000000001", "20240301100000000000000000002", "120240301100000000000000000000"});
}

TEST(NameOrder, DecimalsAndExponents) {
  expect_order({"Result-0.0005.csv", "Result-0.001.csv", "Result-0.0015.csv", "Result-0.002.csv"}, "\"Result-\"");
  expect_order({"t_0.1.csv", "t_0.2.csv", "t_0.30000000000000004.csv", "t_0.4.csv", "t_1.0.csv"}, "number", 5);
  expect_order({"t0.csv", "t0.5.csv", "t1.csv", "t10.5.csv"}, "number", 18);
  expect_order({"t=5e-4", "t=1e-3", "t=1.5e-3", "t=1e-2", "t=1"}, "\"t=\"", 1995);
  expect_order({"t=1e-05.vtk", "t=0.0001.vtk", "t=0.1.vtk", "t=1e+01.vtk"}, "number", 111108);
  expect_order({"0/p.csv", "0.0005/p.csv", "0.001/p.csv", "1e-02/p.csv"}, "number", 17);
  expect_order({"t_0,05.csv", "t_0,1.csv", "t_0,15.csv"}, "number");
  // Times of an adaptive step lie on no raster.
  expect_order({"s_0.013.vtk", "s_0.5.vtk", "s_0.52.vtk", "s_12.1.vtk"}, "number",
               raster_of(order_of_names({"s_0.013", "s_0.5", "s_0.52", "s_12.1"})).missing);
  const NameOrder order = order_of_names({"Result-0.001.csv", "Result-0.0005.csv"});
  EXPECT_TRUE(order.looks_like_times);
  EXPECT_THAT(order.numbers, ElementsAre(0.0005, 0.001));
  EXPECT_FALSE(order_of_names({"a1.csv", "a2.csv"}).looks_like_times);
}

TEST(NameOrder, CountersAfterAPointAreNoDecimals) {
  expect_order({"v1.8.csv", "v1.9.csv", "v1.10.csv", "v1.11.csv"}, "");
  expect_order({"run1.1", "run1.2", "run1.3", "run1.10"}, "counted as whole numbers", 6);
  expect_order({"s1e1.ply", "s1e2.ply", "s1e9.ply", "s1e10.ply", "s1e11.ply"}, "", 6);
}

TEST(NameOrder, TheSameTimeTwiceIsNotTakenForACounter) {
  for (const Names& names : {Names{"0.1/p.csv", "0.10/p.csv", "0.2/p.csv"}, Names{"1.5", "1.50", "2.5"},
                             Names{"t_0.1.csv", "t_0.10.csv", "t_0.2.csv"}, Names{"0.25.csv", "0.250.csv", "0.5.csv"}})
    EXPECT_TRUE(order_of_names(names).twins) << names[1];
}

TEST(NameOrder, Signs) {
  expect_order({"f_-2.csv", "f_-1.csv", "f_0.csv", "f_1.csv"}, "number");
  expect_order({"f-20.csv", "f-10.csv", "f0.csv", "f10.csv"}, "number");
  expect_order({"f_-0002", "f_-0001", "f_0000", "f_0001"}, "number");
  expect_order({"-1.5.csv", "-0.5.csv", "0.5.csv"}, "number");
  expect_order({"t=-1e-3", "t=-5e-4", "t=+5e-4"}, "number", 1);
  expect_order({"p-1.csv", "p-2.csv", "p-10.csv"}, "\"p-\"", 7);
  expect_order({"run1-5.csv", "run1-6.csv", "run1-10.csv"}, "\"-\"", 3);
}

TEST(NameOrder, SeveralNumbers) {
  // Counted particles beside the frame, in either order.
  expect_order({"dam_0_257.csv", "dam_1_258.csv", "dam_2_259.csv"}, "dam_");
  expect_order({"dam_300_0.csv", "dam_280_1.csv", "dam_310_2.csv", "dam_150_3.csv"}, "number");
  // Dates and clocks: the larger unit first.
  expect_order({"2024-03-01T10_00_00.csv", "2024-03-02T10_00_00.csv", "2024-03-10T10_00_00.csv"}, "number", 7);
  expect_order({"2024-03-01T10_40_00", "2024-03-01T11_00_00", "2024-03-01T11_20_00"}, "natural");
  expect_order({"a_10_40", "a_11_00", "a_13_20"}, "number",
               raster_of(order_of_names({"a_10", "a_11", "a_13"})).missing);
}

TEST(NameOrder, LettersThatDifferGiveNaturalOrder) {
  expect_order({"take2_a.x", "take2_b.x", "take10_b.x"}, "differ in letters");
  const NameOrder twins = order_of_names({"f_1.csv", "f_01.csv"});
  EXPECT_TRUE(twins.twins.has_value());
  EXPECT_EQ(order_of_names({"one.csv"}).note, "");
  EXPECT_TRUE(order_of_names({}).order.empty());
}

}  // namespace
}  // namespace flowskin::scenes
