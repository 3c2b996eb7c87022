// Everything that an archive can hold comes back as it was; what is no archive is refused.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/state_archive.h"

namespace flowskin::sph {
namespace {

struct Part {
  int number = 0;
  std::string name;
  template <class Archive>
  void visit(Archive& archive) {
    archive(number, name);
  }
  bool operator==(const Part&) const = default;
};

enum class Color : std::uint8_t { red, green };

struct Everything {
  bool flag = false;
  std::int8_t small = 0;
  std::uint64_t large = 0;
  float single = 0;
  double nan = 0, tiny = 0;
  Color color = Color::red;
  std::string text;
  std::vector<bool> flags;
  std::vector<double> numbers;
  std::vector<Eigen::Vector3d> points;
  std::vector<std::array<int, 3>> triangles;
  std::vector<std::vector<Eigen::Vector3f>> layers;
  std::vector<Part> parts;
  std::optional<Part> some, none;
  std::pair<std::string, double> pair;
  std::map<std::uint64_t, std::string> map;
  std::unordered_map<std::uint64_t, Eigen::Vector3d> hash_map;
  Eigen::VectorXd vector;
  Eigen::MatrixXf matrix;

  template <class Archive>
  void visit(Archive& archive) {
    archive.section("everything");
    archive(flag, small, large, single, nan, tiny, color, text, flags, numbers, points, triangles, layers, parts);
    archive(some, none, pair, map, hash_map, vector, matrix);
  }
};

Everything example() {
  Everything e;
  e.flag = true;
  e.small = -5;
  e.large = ~std::uint64_t{0};
  e.single = 0.1F;
  e.nan = std::nan("7");
  e.tiny = -std::numeric_limits<double>::denorm_min();
  e.color = Color::green;
  e.text = std::string("a\0b", 3);
  e.flags = {true, false, true};
  e.numbers.assign(300000, 0.3);  // more than a piece
  e.points = {{1, 2, 3}, {-0.0, 5, 6}};
  e.triangles = {{0, 1, 2}};
  e.layers = {{}, {{1, 2, 3}}};
  e.parts = {{1, "one"}, {2, ""}};
  e.some = Part{3, "three"};
  e.none = std::nullopt;
  e.pair = {"x", 2.5};
  e.map = {{7, "seven"}, {1, "one"}};
  for (std::uint64_t k = 0; k < 100; ++k) e.hash_map[k * 7919 % 1000] = {double(k), 0, 0};
  e.vector = Eigen::VectorXd::LinSpaced(5, 0, 1);
  e.matrix = Eigen::MatrixXf::Identity(2, 3);
  return e;
}

template <class T>
std::string written(const T& value) {
  std::string bytes;
  StateWriter writer([&](std::string_view piece) { bytes += piece; });
  writer(value);
  writer.flush();
  return bytes;
}

TEST(StateArchive, EverythingComesBack) {
  const Everything before = example();
  const std::string bytes = written(before);
  Everything after;
  after.none = Part{};
  StateReader reader(bytes);
  reader(after);
  EXPECT_EQ(reader.bytes_left(), 0U);
  EXPECT_EQ(std::bit_cast<std::uint64_t>(after.nan), std::bit_cast<std::uint64_t>(before.nan));
  EXPECT_EQ(after.tiny, before.tiny);
  EXPECT_TRUE(std::signbit(after.points[1].x()));
  EXPECT_EQ(after.text, before.text);
  EXPECT_EQ(after.flags, before.flags);
  EXPECT_EQ(after.layers, before.layers);
  EXPECT_EQ(after.parts, before.parts);
  EXPECT_EQ(after.some, before.some);
  EXPECT_FALSE(after.none.has_value());
  EXPECT_EQ(after.map, before.map);
  EXPECT_EQ(after.hash_map, before.hash_map);
  EXPECT_EQ(after.matrix, before.matrix);
  EXPECT_TRUE(written(after) == bytes);
}

TEST(StateArchive, BytesAreLittleEndianWithoutPadding) {
  EXPECT_EQ(written(std::uint32_t{0x01020304}), std::string("\4\3\2\1"));
  EXPECT_EQ(written(1.0F), std::string("\0\0\x80\x3f", 4));
  EXPECT_EQ(written(std::string("ab")), std::string("\2\0\0\0\0\0\0\0ab", 10));
}

TEST(StateArchive, CutOffAnywhereIsRefused) {
  const std::string bytes = written(example());
  for (std::size_t size = 0; size < bytes.size(); size += size < 300 ? 1 : 50021) {
    Everything after;
    StateReader reader(std::string_view(bytes).substr(0, size));
    EXPECT_THROW(reader(after), StateError) << size;
  }
}

TEST(StateArchive, HugeCountsAllocateNothing) {
  const std::string bytes = written(std::uint64_t{1} << 60) + std::string(64, 'x');
  std::vector<double> numbers;
  std::vector<Part> parts;
  std::string text;
  std::map<std::uint64_t, double> map;
  EXPECT_THROW(StateReader{bytes}(numbers), StateError);
  EXPECT_THROW(StateReader{bytes}(parts), StateError);
  EXPECT_THROW(StateReader{bytes}(text), StateError);
  EXPECT_THROW(StateReader{bytes}(map), StateError);
}

TEST(StateArchive, AnotherSectionIsNamed) {
  std::string bytes;
  StateWriter writer([&](std::string_view piece) { bytes += piece; });
  writer.section("tracker");
  writer.flush();
  StateReader reader(bytes);
  try {
    reader.section("solver");
    FAIL() << "must throw";
  } catch (const StateError& error) {
    EXPECT_NE(std::string(error.what()).find("tracker"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("solver"), std::string::npos);
  }
}

TEST(StateArchive, PartsKeepTheirNumber) {
  std::vector<Part> two(2), three(3);
  std::string bytes;
  StateWriter writer([&](std::string_view piece) { bytes += piece; });
  writer.each(two);
  writer.flush();
  StateReader wrong(bytes), right(bytes);
  EXPECT_THROW(wrong.each(three), StateError);
  EXPECT_NO_THROW(right.each(two));
}

}  // namespace
}  // namespace flowskin::sph
